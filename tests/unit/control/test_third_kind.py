"""A kind of vehicle that nobody has thought of drives, is shown and is simulated, from this file alone."""

from math import atan, tan
from typing import Any

import pytest
from unit.control.robot import TICK_US, Robot

from zteleop import sim
from zteleop.control import curvature
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Wheels
from zteleop.control.report import status, to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.stick import Speeds, Stick, to_twist
from zteleop.messages import Pwm, Twist
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.render import render
from zteleop.screen.view import View
from zteleop.sim.body import Body, Pulses

LOCK = 1.0
"""rad to either side, of the one wheel in front that drives and steers"""


class Tricycle:
    kind = "tricycle"
    steers, takes_ticks = True, False
    driven, wheels = frozenset({"front"}), frozenset({"front", "fork"})
    wheelbase, max_steering_angle, max_speed = 1.2, LOCK, 2.0
    max_turn = max_speed * tan(LOCK) / wheelbase

    def mix(self, twist: Twist) -> Wheels:
        angle = atan(self.wheelbase * curvature.of(twist.linear.x, twist.angular.z))
        return {"front": twist.linear.x / self.max_speed, "fork": max(-1.0, min(1.0, angle / LOCK))}

    def unmix(self, wheels: Wheels) -> Twist:
        speed = wheels["front"] * self.max_speed
        return Twist.planar(speed, curvature.turn(speed, tan(wheels["fork"] * LOCK) / self.wheelbase))


class Trike(Body):
    """One whose wheels do at once what their pulses say."""

    def __init__(self, mixer: Tricycle, servos: dict[str, Servo]) -> None:
        super().__init__()
        self._mixer, self._servos = mixer, servos

    def move(self, pulse_us: Pulses, dt: float) -> None:
        widths = {name: pulse_us.get(servo.channel) or 1500.0 for name, servo in self._servos.items()}
        twist = self._mixer.unmix({name: self._servos[name].fraction(us) for name, us in widths.items()})
        self.speed, self.yaw_rate = twist.linear.x, twist.angular.z


SERVOS = {name: Servo(channel, 1000.0, 1500.0, 2000.0) for channel, name in ((4, "front"), (5, "fork"))}


@pytest.fixture
def settings() -> DriveSettings:
    mixer: Any = Tricycle()
    return DriveSettings(mixer, SERVOS, limits=Limits(acceleration=100.0))


def test_it_drives_and_is_simulated(settings: DriveSettings, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sim.VEHICLES, "tricycle", Trike)
    robot, body = Robot(settings), sim.make_vehicle(settings.mixer, SERVOS)
    vehicle = to_vehicle(settings, TICK_US)
    wanted = to_twist(Stick(0.5, 1.0, True), Speeds(forward=2.0), vehicle)
    assert wanted is not None
    assert (wanted.linear.x, wanted.angular.z) == pytest.approx((1.0, tan(LOCK) / 1.2))
    body.step(robot.hold(wanted, 0.5).pulse_us, 0.1)
    assert (body.speed, body.yaw_rate) == pytest.approx((1.0, tan(LOCK) / 1.2))
    body.step(robot.wait(0.4).pulse_us, 0.1)
    assert (body.speed, body.yaw_rate) == (0.0, 0.0)


def test_it_is_told_and_shown(settings: DriveSettings) -> None:
    robot, vehicle = Robot(settings), to_vehicle(settings, TICK_US)
    assert (vehicle.kind, vehicle.steers, vehicle.takes_ticks) == ("tricycle", True, False)
    assert {channel.name: channel.channel for channel in vehicle.channels} == {"front": 4, "fork": 5}
    step = robot.hold(Twist.planar(1.0), 0.5)
    said = status(robot.drive, step, robot.chip(step), robot.now)
    board = Dashboard("trike", "hold", Speeds(), View(vehicle=vehicle, status=said))
    page = "\n".join(render(board, 80, 24, unicode=False, color=False))
    assert "allowed" in page
    assert "+1.00 m/s" in page
    assert "full lock" in page, "who steers has no yaw rate of his own"


def test_it_knows_no_ticks(settings: DriveSettings) -> None:
    assert Robot(settings).say(Pwm(400, 400)) is Refusal.NO_SUCH_CHANNEL
