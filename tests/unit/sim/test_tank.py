import pytest

from zteleop.control.mixer import Differential
from zteleop.control.servo import Servo
from zteleop.messages import Time, Twist
from zteleop.sim.tank import Tank

MIXER = Differential(track=0.2, max_speed=1.0)
SERVOS = {"left": Servo(4), "right": Servo(9)}


@pytest.fixture
def tank() -> Tank:
    return Tank(MIXER, SERVOS)


def drive(tank: Tank, twist: Twist, seconds: float) -> None:
    wheels = MIXER.mix(twist)
    pulse_us = {SERVOS[name].channel: SERVOS[name].pulse_us(value) for name, value in wheels.items()}
    for _ in range(round(seconds / 0.02)):
        tank.step(pulse_us, 0.02)


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_it_turns_in_place(tank: Tank, turn: float) -> None:
    drive(tank, Twist.planar(0.0, turn), 2.0)
    assert tank.yaw_rate == pytest.approx(turn, abs=1e-5)
    assert tank.heading * turn > 1.5
    assert (tank.x, tank.y, tank.distance) == pytest.approx((0, 0, 0))


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_it_goes_straight_both_ways(tank: Tank, speed: float) -> None:
    drive(tank, Twist.planar(speed), 2.0)
    assert tank.speed == pytest.approx(speed, abs=1e-4)
    assert tank.x * speed > 0
    assert (tank.y, tank.heading) == pytest.approx((0, 0))


def test_an_arc_has_the_radius_commanded(tank: Tank) -> None:
    drive(tank, Twist.planar(0.5, 1.0), 2.0)
    assert tank.speed / tank.yaw_rate == pytest.approx(0.5, abs=1e-5)
    assert tank.wheel_speeds == pytest.approx((0.4, 0.6), abs=1e-4)
    assert tank.y > 0


def test_one_output_off_turns_it_around_that_wheel(tank: Tank) -> None:
    for _ in range(100):
        tank.step({SERVOS["right"].channel: 1750.0, SERVOS["left"].channel: None}, 0.02)
    assert tank.wheel_speeds == pytest.approx((0.0, 0.5), abs=1e-4)
    assert tank.yaw_rate == pytest.approx(0.5 / 0.2, abs=1e-3)


def test_it_says_where_it_is(tank: Tank) -> None:
    drive(tank, Twist.planar(0.5), 1.0)
    assert tank.odometry(Time(1, 2)).pose.pose.position.x == tank.x > 0
