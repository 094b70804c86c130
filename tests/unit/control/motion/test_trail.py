from math import pi

import pytest

from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.trail import MOVED, Trail


def driven(way: float, turned: float, steps: int = 200, rest: int = 10) -> Trail:
    """Return the trail of an arc, with a rest before and after it; 20 poses a second."""
    trail, pose, now = Trail(), Pose2D(1.0, 2.0, 3.0), 100.0
    for step in range(steps + 2 * rest):
        if rest <= step < rest + steps:
            pose = pose.roll(way / steps, turned / steps)
        trail.add(pose, now)
        now += 0.05
    return trail


def test_a_circle_is_measured() -> None:
    trail = driven(2 * pi * 0.5, 2 * pi)
    assert trail.radius() == pytest.approx(0.5, abs=1e-6)
    assert trail.turned == pytest.approx(2 * pi)
    assert trail.way == pytest.approx(pi, rel=1e-3)
    assert trail.seconds == pytest.approx(10.0, abs=0.11)
    assert trail.end.distance(trail.start.x, trail.start.y) < 1e-9


def test_to_the_right_it_turns_less_than_nothing() -> None:
    trail = driven(2 * pi, -4 * pi)
    assert trail.turned == pytest.approx(-4 * pi)
    assert trail.radius() == pytest.approx(0.5, abs=1e-6)


def test_a_beginning_that_is_no_circle_yet_does_not_spoil_it() -> None:
    trail, pose = Trail(), Pose2D()
    for step in range(240):
        turned = 0.01 if step < 20 else 2 * pi / 200
        pose = pose.roll(2 * pi * 0.5 / 200, turned)
        trail.add(pose, step * 0.05)
    assert trail.radius() == pytest.approx(0.5, abs=0.001)


def test_a_line_has_no_radius() -> None:
    assert driven(1.0, 0.0).radius() is None


def test_nothing_is_no_trail() -> None:
    trail = Trail()
    assert not trail
    assert (trail.turned, trail.seconds, trail.way) == (0.0, 0.0, 0.0)
    assert trail.radius() is None


def test_noise_is_no_move() -> None:
    trail = Trail()
    for step in range(100):
        trail.add(Pose2D(MOVED / 3 * (step % 2), 0.0, 0.0), step * 0.05)
    assert trail.seconds == 0.0


def test_a_turn_on_the_spot_is_a_move() -> None:
    assert driven(0.0, 1.0, rest=0).seconds == pytest.approx(10.0, abs=0.2)
