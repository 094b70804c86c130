from math import hypot, tan

import pytest

from zteleop.control.mixer import Ackermann
from zteleop.control.servo import Servo
from zteleop.messages import Twist
from zteleop.sim.body import Pulses
from zteleop.sim.car import Car, CarSettings

STEERING, THROTTLE = 1, 0
MIXER = Ackermann(wheelbase=0.25, max_steering_angle=0.4, max_speed=3.0)
SERVOS = {"steering": Servo(STEERING), "throttle": Servo(THROTTLE)}
STILL = {STEERING: 1500.0, THROTTLE: 1500.0}


@pytest.fixture
def car() -> Car:
    return Car(MIXER, SERVOS)


def pulses(twist: Twist) -> dict[int, float]:
    wheels = MIXER.mix(twist)
    return {SERVOS[name].channel: SERVOS[name].pulse_us(value) for name, value in wheels.items()}


def drive(car: Car, pulse_us: Pulses, seconds: float, dt: float = 0.02) -> None:
    for _ in range(round(seconds / dt)):
        car.step(pulse_us, dt)


def test_at_neutral_it_stands(car: Car) -> None:
    drive(car, STILL, 2.0)
    assert (car.x, car.y, car.heading, car.distance) == (0, 0, 0, 0)


def test_straight_is_straight_at_the_speed_commanded(car: Car) -> None:
    drive(car, pulses(Twist.planar(1.0)), 3.0)
    assert car.speed == pytest.approx(1.0)
    assert (car.y, car.heading, car.yaw_rate) == (0.0, 0.0, 0.0)
    assert 2.5 < car.x < 3.0
    assert car.distance == pytest.approx(car.x)


@pytest.mark.parametrize(("turn", "side"), [(1.0, 1), (-1.0, -1)])
def test_a_circle_has_the_radius_of_the_bicycle_model(car: Car, turn: float, side: int) -> None:
    command = pulses(Twist.planar(1.0, turn))
    drive(car, command, 2.0)
    assert car.yaw_rate == pytest.approx(turn, abs=1e-5)
    radius = MIXER.wheelbase / tan(car.steering_angle)
    assert radius == pytest.approx(side * 1.0, abs=1e-5)
    xs, ys = [], []
    for _ in range(350):
        car.step(command, 0.02)
        xs.append(car.x)
        ys.append(car.y)
    assert max(xs) - min(xs) == pytest.approx(2.0, abs=0.002)
    assert max(ys) - min(ys) == pytest.approx(2.0, abs=0.002)


def test_left_ends_on_the_left(car: Car) -> None:
    drive(car, pulses(Twist.planar(0.5, 0.5)), 2.0)
    assert car.y > 0
    assert car.heading > 0
    assert car.steering_angle > 0


def test_in_reverse_it_goes_back_and_left_wheels_turn_it_right(car: Car) -> None:
    drive(car, {STEERING: 1800.0, THROTTLE: 1400.0}, 1.5)
    assert car.speed == pytest.approx(-0.6, abs=0.01)
    assert car.x < 0
    assert car.yaw_rate < 0
    assert car.y > 0


def test_the_wheels_turn_at_the_speed_of_the_servo() -> None:
    car = Car(MIXER, SERVOS, CarSettings(servo_speed=2.0))
    car.step({STEERING: 2000.0, THROTTLE: 1500.0}, 0.05)
    assert car.steering_angle == pytest.approx(0.1)
    drive(car, {STEERING: 2000.0, THROTTLE: 1500.0}, 0.3)
    assert car.steering_angle == pytest.approx(0.4)


@pytest.mark.parametrize("off", [{}, {STEERING: None, THROTTLE: None}])
def test_with_its_outputs_off_the_wheels_stay_and_it_rolls_to_a_stand(car: Car, off: dict[int, None]) -> None:
    drive(car, pulses(Twist.planar(1.0, 1.0)), 2.0)
    angle = car.steering_angle
    drive(car, off, 2.0)
    assert car.speed == 0.0
    assert car.steering_angle == angle > 0.2


def test_neutral_stops_it_within_a_short_way(car: Car) -> None:
    drive(car, pulses(Twist.planar(1.0)), 2.0)
    before = car.x
    drive(car, STILL, 2.0)
    assert (car.speed, car.yaw_rate) == (0.0, 0.0)
    assert 0 < car.x - before < 0.25


def test_the_length_of_a_step_hardly_matters() -> None:
    coarse, fine = Car(MIXER, SERVOS), Car(MIXER, SERVOS)
    command = pulses(Twist.planar(1.0, 0.8))
    drive(coarse, command, 3.0, dt=0.1)
    drive(fine, command, 3.0, dt=0.005)
    assert hypot(coarse.x - fine.x, coarse.y - fine.y) < 0.01


def test_a_bend_that_its_tyres_cannot_hold_is_wider() -> None:
    """At 0.5 m/s it turns as its wheels point; at 3 m/s only as its grip allows."""
    car, lock = Car(MIXER, SERVOS), {STEERING: 2000.0}
    for _ in range(300):
        car.step(lock | {THROTTLE: SERVOS["throttle"].pulse_us(0.5 / MIXER.max_speed)}, 0.01)
    radius = MIXER.wheelbase / tan(MIXER.max_steering_angle)
    assert car.speed / car.yaw_rate == pytest.approx(radius, rel=0.01)
    for _ in range(300):
        car.step(lock | {THROTTLE: 2000.0}, 0.01)
    assert car.speed * car.yaw_rate == pytest.approx(CarSettings().grip, rel=0.01)
