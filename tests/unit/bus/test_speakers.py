import pytest
from unit.bus.fakes import Session, put

from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.bus.speakers import LOOK_EVERY, Speakers
from zteleop.testing import Clock

SIM = "robot/abe/live/pub/sim/pi-7/nav_msgs.msg.Odometry/odom"
OTHER = "robot/abe/live/pub/odometer/pi-8/nav_msgs.msg.Odometry/odom"
NOBODY = "nobody publishes abe/odom (zteleop list -v shows what is said, and by whom)"
GONE = "nobody publishes abe/odom any more (zteleop list -v shows what is said, and by whom)"


class Desk:
    """A subscriber's loop, and whoever speaks to it."""

    def __init__(self, clock: Clock) -> None:
        self.session, self.told, self._clock = Session(), list[str](), clock
        self.loop = Loop(lambda: None)
        speakers = Speakers(self.session, Name("abe", "odom"), self.told.append, self.told.append)  # type: ignore[arg-type]
        speakers.watch(self.loop)

    def after(self, looks: int, *keys: str, is_put: bool = True) -> list[str]:
        """Let some come or go, and return what is told within so many looks."""
        self.told.clear()
        self.session.comings.samples.extend(put(b"", key=key, is_put=is_put) for key in keys)
        for _ in range(looks):
            self._clock.pass_by(LOOK_EVERY)
            self.loop.run_once(self._clock.time)
        return list(self.told)


@pytest.fixture
def desk(clock: Clock) -> Desk:
    return Desk(clock)


def test_who_waits_in_vain_is_told_within_two_seconds_and_once(desk: Desk) -> None:
    assert desk.after(1) == []
    assert desk.after(1) == [NOBODY]
    assert desk.after(10) == []
    assert desk.after(1, SIM) == ["abe/odom is published now"]
    assert desk.after(10) == []


def test_who_waits_for_a_name_that_is_nearly_one_is_asked(desk: Desk) -> None:
    itself = SIM.replace("/pub/", "/sub/")
    desk.session.alive = [SIM.replace("odom", "odo"), SIM.replace("/abe/", "/zoe/"), itself]
    assert desk.after(2) == [NOBODY.replace(" (zteleop", "; did you mean odo? (zteleop")]


def test_where_somebody_speaks_nothing_is_said(desk: Desk) -> None:
    assert desk.after(10, SIM, OTHER) == []
    assert desk.after(10, SIM, is_put=False) == [], "the other is there"
    assert desk.after(2, OTHER, is_put=False) == [GONE]


def test_who_is_back_after_a_moment_was_not_gone(desk: Desk) -> None:
    desk.after(2, SIM)
    assert desk.after(1, SIM, is_put=False) == []
    assert desk.after(5, SIM) == []
