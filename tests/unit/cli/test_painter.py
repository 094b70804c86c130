from typing import Any

import pytest
from unit.screen.boards import pulses, status

from zteleop.cli import _painter
from zteleop.cli._painter import HEARD_WITHIN, TRAIL_STEP, Painter
from zteleop.inputs.keyboard import Keyboard
from zteleop.messages import DriveStatus, Odometry, Pwm, Vehicle
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.view import View
from zteleop.testing import Clock, FakeTerminal


class Wall(FakeTerminal):
    """A terminal that keeps what was drawn on it."""

    unicode, color, columns = True, False, 100

    def __init__(self) -> None:
        super().__init__()
        self.pages: list[list[str]] = []

    def size(self) -> tuple[int, int]:
        return self.columns, 30

    def draw(self, lines: list[str]) -> None:
        self.pages.append(lines)


class Easel:
    """A painter, and how often it worked out a page."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, clock: Clock, car: Vehicle) -> None:
        self.wall, self.clock, self.car, self.worked = Wall(), clock, car, 0
        terminal: Any = self.wall
        keyboard = Keyboard("step", terminal=terminal)
        keyboard.fit(car)
        self.painter = Painter(keyboard, Dashboard("archangel", "step", keyboard.speeds))
        self.render = _painter.render
        monkeypatch.setattr(_painter, "render", self.count)

    def count(self, *arguments: Any, **options: Any) -> list[str]:
        self.worked += 1
        return self.render(*arguments, **options)

    def show(self, x: float = 0.0, said: DriveStatus | None = None, y: float = 0.0, **seen: Any) -> str:
        self.clock.pass_by(0.05)
        odom = Odometry.zero()
        odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
        odom.header.stamp.sec = round(self.clock.time)
        self.painter(View(self.clock.time, self.car, status=said, odom=odom, **seen))
        return "\n".join(self.wall.pages[-1])


@pytest.fixture
def easel(monkeypatch: pytest.MonkeyPatch, clock: Clock, car: Vehicle) -> Easel:
    return Easel(monkeypatch, clock, car)


def idle(car: Vehicle, **changes: Any) -> DriveStatus:
    return status(state="idle", operator="", pulses=pulses(car, {}), **changes)


def test_a_page_is_worked_out_once_and_shown_as_often_as_asked(easel: Easel, car: Vehicle) -> None:
    for beat in range(20):
        easel.show(said=idle(car, written=beat * 0.05, seq=beat, refused=beat, latency=beat * 0.001))
    assert (easel.worked, len(easel.wall.pages)) == (1, 20)


def test_whatever_can_be_seen_is_shown_at_once(easel: Easel, car: Vehicle) -> None:
    easel.show(said=idle(car))
    for seen in (
        {"said": idle(car, why="a cat")},
        {"said": idle(car, why="a cat"), "note": "news"},
        {"said": idle(car, why="a cat"), "note": "news", "command": Pwm(400, 370)},
        {"said": None},
    ):
        before = easel.worked
        easel.show(**seen)
        assert easel.worked == before + 1, seen
    easel.wall.columns = 60
    assert max(map(len, easel.show(said=None).splitlines())) <= 60


def test_a_motion_is_shown_ten_times_a_second_and_to_its_end(easel: Easel, car: Vehicle) -> None:
    for x in range(20):
        easel.show(x / 100, idle(car))
    assert easel.worked == 10
    assert "x 0.19" in easel.show(0.19, idle(car))
    assert easel.worked == 11


def test_a_trail_is_where_the_robot_has_been(
    monkeypatch: pytest.MonkeyPatch, easel: Easel, car: Vehicle
) -> None:
    for x in (0.0, TRAIL_STEP / 2, 2 * TRAIL_STEP, 2.1 * TRAIL_STEP, 5 * TRAIL_STEP):
        easel.show(x, idle(car))
    assert list(easel.painter._trail) == [(0.0, 0.0), (2 * TRAIL_STEP, 0.0), (5 * TRAIL_STEP, 0.0)]
    easel.show(5 * TRAIL_STEP, idle(car), y=-2 * TRAIL_STEP)
    assert easel.painter._trail[-1] == (5 * TRAIL_STEP, -2 * TRAIL_STEP)
    easel.painter(View(easel.clock.time, car, status=idle(car)))
    assert len(easel.painter._trail) == 4


def test_a_robot_not_heard_yet_is_looked_for_and_then_said_to_be_missing(
    easel: Easel,
) -> None:
    assert "● looking" in easel.show()
    easel.clock.pass_by(HEARD_WITHIN)
    assert "● no actuator" in easel.show()


def test_after_it_was_heard_nobody_looks_for_it(easel: Easel, car: Vehicle) -> None:
    easel.clock.pass_by(HEARD_WITHIN)
    assert "idle" in easel.show(said=idle(car))
    assert "no actuator" in easel.show()
