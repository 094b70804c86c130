from types import SimpleNamespace
from typing import Any

import pytest
from unit.bus.fakes import Ring, sample

from zteleop.bus import codec
from zteleop.bus.in_the_way import LOOK_EVERY, InTheWay
from zteleop.bus.subscription import Subscription
from zteleop.messages import Log, Time
from zteleop.testing import Clock

WALL = "it stands at the wall, and can only drive away from there"


class Desk:
    """A program that moves a robot, or does not, and what it is told."""

    def __init__(self) -> None:
        self.ring, self.told = Ring(), list[str]()
        self.answer: Any = SimpleNamespace(moves=True)
        logs = Subscription(self.ring, codec.decoders([Log]), pytest.fail)
        self.way = InTheWay(logs, "abe", self.answer, self.told.append)

    def hears(self, name: str = "sim", level: int = Log.WARN) -> list[str]:
        self.told.clear()
        self.ring.samples.append(sample(Log(Time(0, 0), level, name, WALL, "", "", 0)))
        self.way.look()
        return list(self.told)


def test_who_moves_a_robot_is_told_what_stands_in_its_way() -> None:
    assert Desk().hears() == [f"robot abe does not move on, says its sim: {WALL}"]


@pytest.mark.parametrize(("name", "level"), [("sim", Log.INFO), ("actuator", Log.WARN), ("nose", Log.ERROR)])
def test_what_others_say_and_what_is_no_warning_is_not_handed_on(name: str, level: int) -> None:
    assert Desk().hears(name, level) == []


def test_who_moves_nothing_now_is_not_told_and_not_later_either() -> None:
    desk = Desk()
    desk.answer.moves = False
    assert desk.hears() == []
    desk.answer.moves = True
    desk.way.look()
    assert desk.told == []


def test_it_looks_again(clock: Clock) -> None:
    assert Desk().way.look() == clock.time + LOOK_EVERY
