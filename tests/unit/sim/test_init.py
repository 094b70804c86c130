import pytest

from zteleop.control.mixer import Ackermann, Differential
from zteleop.control.servo import Servo
from zteleop.errors import ConfigError
from zteleop.sim import make_vehicle
from zteleop.sim.car import Car
from zteleop.sim.tank import Tank


def test_the_mixer_decides_what_moves() -> None:
    assert isinstance(make_vehicle(Ackermann(), {"steering": Servo(1), "throttle": Servo(0)}), Car)
    assert isinstance(make_vehicle(Differential(), {"left": Servo(0), "right": Servo(1)}), Tank)


def test_a_wheel_without_a_servo_is_named() -> None:
    with pytest.raises(ConfigError, match=r"needs servos for steering, throttle; found left, right"):
        make_vehicle(Ackermann(), {"left": Servo(0), "right": Servo(1)})
    with pytest.raises(ConfigError, match=r"needs servos for right; found left"):
        make_vehicle(Differential(), {"left": Servo(0)})
