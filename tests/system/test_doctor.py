"""`zteleop doctor` beside a robot: what it says of those that are there is so."""

import time

import pytest
from rig import Rig

from zteleop.bus import clock
from zteleop.messages import Time

AHEAD = 42


def finding(text: str, check: str) -> str:
    """Return what a check says."""
    return next(line[18:] for line in text.splitlines() if line[7:17].strip() == check)


def test_whose_clock_is_another_is_named_and_a_process_that_nobody_sits_before(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    actuator = rig.actuator()
    told = rig.result("doctor", *rig.bus_options()).stdout
    assert f"actuator ({actuator.process.pid}, for 00:" in finding(told, "processes")
    assert "each within 0.5 s of this machine's clock" in finding(told, "clocks")
    assert finding(told, "robots") == "heard here: bench"

    def stamp() -> Time:
        seconds, nanoseconds = divmod(time.time_ns(), 1_000_000_000)
        return Time(seconds + AHEAD, nanoseconds)

    rig.node("late")  # which never spins
    monkeypatch.setattr(clock, "stamp", stamp)
    told = rig.result("doctor", *rig.bus_options()).stdout
    assert finding(told, "clocks").startswith("/bench/late is 42.0 s ahead of this machine's clock")
