"""A Create 3 as its wheels move it."""

import pytest

from zteleop.control.create3 import ACCELERATION, SAFE_SPEED, TRACK
from zteleop.control.servo import Servo
from zteleop.sim.create3.backup import BUFFER
from zteleop.sim.create3.body import RADIUS, Create3
from zteleop.sim.create3.hazards import BACKUP_LIMIT, Hazard
from zteleop.sim.scene import Scene, Wall
from zteleop.sim.world import World

WHEELS = {"left": Servo(0), "right": Servo(1)}


TICK = 1e6 / 60 / 4096
"""us, of a chip at 60 Hz"""


def pulses(left: float, right: float) -> dict[int, float | None]:
    """Return what a chip makes of two shares: whole ticks."""
    shares = (WHEELS["left"].pulse_us(left), WHEELS["right"].pulse_us(right))
    return {channel: round(width / TICK) * TICK for channel, width in enumerate(shares)}


@pytest.fixture
def robot() -> Create3:
    return Create3(WHEELS)


def test_full_pulses_are_as_fast_as_its_safety_allows(robot: Create3) -> None:
    robot.step(pulses(1.0, 1.0), 1.0)
    assert (robot.speed, robot.yaw_rate) == (SAFE_SPEED, 0.0)
    robot.step(pulses(0.5, 1.0), 1.0)
    assert robot.yaw_rate == pytest.approx(0.5 * SAFE_SPEED / TRACK, rel=0.02)


def test_it_speeds_up_and_brakes_softly(robot: Create3) -> None:
    robot.step(pulses(1.0, 1.0), 0.1)
    assert robot.speed == pytest.approx(0.1 * ACCELERATION)
    robot.step({}, 0.05)
    assert robot.speed == pytest.approx(0.05 * ACCELERATION), "no pulse is rest"


def test_it_reverses_no_farther_than_it_came_and_not_at_all_at_first(robot: Create3) -> None:
    robot.step(pulses(-1.0, -1.0), 1.0)
    assert robot.x == 0.0
    assert robot.hazards == [Hazard(BACKUP_LIMIT, "base_link")]
    robot.step(pulses(1.0, 1.0), 1.0)
    assert robot.hazards == []
    robot.step(pulses(0.0, 0.0), 1.0)
    farthest = robot.x
    for _ in range(3):
        robot.step(pulses(-1.0, -1.0), 1.0)
    assert farthest - robot.x == pytest.approx(BUFFER, abs=0.06), "and what it needs to come to rest"
    assert robot.speed == 0.0
    assert robot.hazards == [Hazard(BACKUP_LIMIT, "base_link")]


@pytest.mark.parametrize("share", [0.1, 0.19, 0.38, 0.7, 1.0, -0.38, -1.0])
def test_turning_on_the_spot_needs_no_way_back_however_long(robot: Create3, share: float) -> None:
    for _ in range(20):
        robot.step(pulses(-share, share), 1.0)
        assert robot.hazards == []
    assert robot.yaw_rate == pytest.approx(2 * share * SAFE_SPEED / TRACK, abs=0.02)


def test_at_rest_it_stands_though_a_chip_rounds_its_pulses(robot: Create3) -> None:
    assert pulses(0.0, 0.0)[0] != 1500.0
    for _ in range(60):
        robot.step(pulses(0.0, 0.0), 1.0)
    assert (robot.x, robot.wheels.speeds, robot.wheels.ticks) == (0.0, (0.0, 0.0), (0, 0))


def test_against_a_wall_it_stands_with_both_wheels(robot: Create3) -> None:
    robot.room = World(Scene(walls=[Wall([(0.5, -1.0), (0.5, 1.0)])]), robot.discs)
    for _ in range(4):
        robot.step(pulses(1.0, 1.0), 1.0)
    assert robot.x == pytest.approx(0.5 - RADIUS, abs=0.01)
    assert (robot.speed, robot.wheels.speeds) == (0.0, (0.0, 0.0))
    ticks, came = robot.wheels.ticks, robot.x
    for _ in range(20):
        robot.step(pulses(1.0, 1.0), 1.0)
    assert robot.wheels.ticks == ticks, "wheels that push a wall turn no farther"
    for _ in range(4):
        robot.step(pulses(-1.0, -1.0), 1.0)
    assert came - robot.x <= BUFFER + 0.06


def test_pushing_a_wall_is_no_way_that_it_could_go_back(robot: Create3) -> None:
    robot.room = World(Scene(walls=[Wall([(RADIUS + 0.02, -1.0), (RADIUS + 0.02, 1.0)])]), robot.discs)
    for _ in range(20):
        robot.step(pulses(1.0, 1.0), 1.0)
    for _ in range(4):
        robot.step(pulses(-1.0, -1.0), 1.0)
    assert robot.x > -0.06, "it came two centimetres"
