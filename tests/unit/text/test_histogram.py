import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.text.histogram import MOST, bars, percentile, percentiles, table


def test_percentiles_of_a_hundred() -> None:
    values = [float(number) for number in range(1, 101)]
    assert percentiles(reversed(values)) == (51.0, 91.0, 100.0, 100.0)
    assert percentile([], 50) == 0.0


def test_a_table_shows_seconds_as_milliseconds_under_their_names() -> None:
    assert table("ms", [("sent to received", [0.001, 0.002]), ("all", [])]).splitlines() == [
        "ms                    p50      p90      p99      max",
        "sent to received     2.00     2.00     2.00     2.00",
        "all                  0.00     0.00     0.00     0.00",
    ]


def test_bars_have_round_ends_and_the_longest_is_the_width() -> None:
    assert bars([0.0012] * 3 + [0.0018] * 6 + [0.004], width=8).splitlines() == [
        "    <= 1.5 ████ 3",
        "      <= 2 ████████ 6",
        "      <= 3 ",
        "      <= 5 █▍ 1",
    ]


def test_a_plain_terminal_gets_plain_bars() -> None:
    assert bars([0.001, 0.001, 0.002], width=4, plain=True).splitlines()[0] == "      <= 1 #### 2"
    assert bars([0.001, 0.0015], plain=True).isascii()


def test_no_value_no_bar() -> None:
    assert bars([]) == ""


@given(st.lists(st.floats(0, 1e6), min_size=1, max_size=50))
def test_every_value_is_in_a_bar(values: list[float]) -> None:
    lines = bars(values, plain=True).splitlines()
    counts = [int(line.split()[-1]) for line in lines if "#" in line]
    assert sum(counts) == len(values)
    assert len(lines) <= MOST


@pytest.mark.parametrize("value", [0.0, 1e-9, 1e-3, 1.0, 1e5])
def test_one_value_is_one_bar(value: float) -> None:
    (line,) = bars([value], width=2).splitlines()
    assert line.endswith("██ 1")
