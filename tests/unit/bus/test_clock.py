import time

import pytest

from zteleop.bus import clock
from zteleop.messages import Time


def test_now_never_goes_back() -> None:
    times = [clock.now() for _ in range(100)]
    assert times == sorted(times)


def test_now_counts_on_while_the_machine_sleeps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "_BOOTTIME", 7)
    monkeypatch.setattr(time, "clock_gettime", {7: 12.5}.__getitem__)
    assert clock.now() == 12.5


def test_where_there_is_no_such_clock_now_is_monotonic(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clock, "_BOOTTIME", None)
    monkeypatch.setattr(time, "monotonic", lambda: 3.5)
    assert clock.now() == 3.5


@pytest.mark.parametrize(
    ("nanoseconds", "stamp"),
    [
        (0, Time(0, 0)),
        (1_700_000_000_123_456_789, Time(1_700_000_000, 123_456_789)),
        (1_999_999_999, Time(1, 999_999_999)),
    ],
)
def test_a_stamp_is_the_time_of_day(monkeypatch: pytest.MonkeyPatch, nanoseconds: int, stamp: Time) -> None:
    monkeypatch.setattr(time, "time_ns", lambda: nanoseconds)
    assert clock.stamp() == stamp
