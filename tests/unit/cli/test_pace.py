import pytest

from zteleop.cli._pace import TELL_AFTER, Pace


def told(rate: float, period: float, seconds: float) -> list[str]:
    pace = Pace(rate)
    return [words for tick in range(int(seconds / period)) if (words := pace.count(tick * period))]


@pytest.mark.parametrize("rate", [0.1, 1.0, 50.0, 1000.0])
def test_as_often_as_asked_is_nothing_to_tell(rate: float) -> None:
    assert told(rate, 1 / rate, max(5.0, 5 / rate)) == []
    assert told(rate, 1.05 / rate, max(5.0, 5 / rate)) == [], "within what a timer does"


def test_what_comes_too_seldom_is_told_once() -> None:
    assert told(1000.0, 0.002, 3 * TELL_AFTER) == ["comes to 500 a second, of the 1000 asked for"]


def test_a_while_in_which_it_stood_still_is_no_slowness() -> None:
    pace = Pace(10.0)
    assert [words for tick in range(15) if (words := pace.count(0.1 * tick))] == []
    assert [words for tick in range(50) if (words := pace.count(9.0 + 0.1 * tick, 9.0))] == []
    assert [words for tick in range(15) if (words := pace.count(15.0 + 0.2 * tick, 9.0))], "that is slow"


def test_a_short_run_is_no_measure() -> None:
    assert told(1000.0, 0.002, 0.9 * TELL_AFTER) == []
