"""Somebody who sees nothing but the wheels finds out what an unknown car is, in simulated time."""

from collections.abc import Callable

import pytest

from zteleop.control.measuring import STEPS, Measuring
from zteleop.control.mixer import Ackermann
from zteleop.control.settings import DONKEYCAR
from zteleop.sim.car import Car
from zteleop.sim.unknown import unknown

TICK = 4.08
KEY = 1 / 20
"""s between two repeats of a key that is held"""
LOOKS = 0.6
"""s that somebody looks before he says so"""


class Eye:
    """Turns one channel a tick at a time, and looks at the wheels."""

    def __init__(self, car: Car) -> None:
        self.car = car
        self.ticks = {name: round(servo.neutral_us / TICK) for name, servo in DONKEYCAR.items()}
        self.seconds = 0.0

    def turn(self, axis: str, ticks: int, seconds: float = KEY) -> None:
        self.ticks[axis] += ticks
        pulses = {DONKEYCAR[name].channel: TICK * count for name, count in self.ticks.items()}
        self.car.step(pulses, seconds)
        self.seconds += seconds

    def until(self, axis: str, step: int, seen: Callable[[], bool]) -> int:
        """Turn until something is seen, and a little back and forth at the end; return the ticks."""
        while not seen():
            self.turn(axis, step)
            self.turn(axis, 0, LOOKS / 4)
        while seen():
            self.turn(axis, -step)
            self.turn(axis, 0, LOOKS)
        self.turn(axis, step)
        self.turn(axis, 0, LOOKS)
        return self.ticks[axis]

    def tap(self) -> None:
        """Brake and be neutral again: many an ESC wants it before it reverses."""
        self.turn("throttle", -60, 0.5)
        self.turn("throttle", 60, 0.5)
        self.turn("throttle", 0, 1.0)  # it may go on turning: what is taken for neutral need be none

    def rest(self, axis: str) -> None:
        self.turn(axis, round(DONKEYCAR[axis].neutral_us / TICK) - self.ticks[axis], 1.0)
        self.turn(axis, 0, 1.0)


@pytest.mark.parametrize("seed", range(8))
def test_all_of_it_is_found_within_two_ticks_and_each_end_within_twenty_seconds(seed: int) -> None:
    really, settings = unknown(DONKEYCAR, seed)
    eye = Eye(Car(Ackermann(), really, settings))
    measuring = Measuring(DONKEYCAR, TICK)
    left = 1 if really["steering"].max_us > really["steering"].neutral_us else -1

    def angle() -> float:
        return eye.car.steering_angle

    def speed() -> float:
        return eye.car.speed

    def end(axis: str, step: int, value: Callable[[], float], hardly: float) -> int:
        """Hold the key until nothing changes any more, then go back to the last tick that did."""
        unchanged = 0
        while unchanged < 10:
            before = value()
            eye.turn(axis, step)
            unchanged = unchanged + 1 if abs(value() - before) < hardly and abs(value()) > 0.05 else 0
        most = value()
        while abs(value() - most) < hardly:
            eye.turn(axis, -step, LOOKS)
        eye.turn(axis, step, LOOKS)
        return eye.ticks[axis]

    finds: dict[str, Callable[[], int]] = {
        "forward starts": lambda: eye.until("throttle", 1, lambda: speed() > 0.01),
        "reverse starts": lambda: eye.tap() or eye.until("throttle", -1, lambda: speed() < -0.01),
        "straight": lambda: (
            eye.until("steering", left, lambda: angle() > 0)
            if angle() <= 0
            else eye.until("steering", -left, lambda: angle() <= 0)
        ),
        "full left": lambda: end("steering", left, angle, 1e-4),
        "full right": lambda: end("steering", -left, angle, 1e-4),
        "full forward": lambda: end("throttle", 1, speed, 2e-3),
        "full reverse": lambda: eye.tap() or end("throttle", -1, speed, 2e-3),
    }
    for step in STEPS:
        if measuring.is_over:
            measuring.go_on()
        eye.seconds = 0.0
        assert measuring.take(TICK * finds[step.find]()) == "", (step.find, eye.ticks)
        assert eye.seconds < 20, step.find
        eye.rest(step.axis)
    for name, servo in measuring.servos().items():
        for field in ("min_us", "neutral_us", "max_us"):
            off = (getattr(servo, field) - getattr(really[name], field)) / TICK
            assert abs(off) <= 2, (name, field, off)


def test_each_seed_is_another_car_and_always_the_same() -> None:
    assert unknown(DONKEYCAR, 3) == unknown(DONKEYCAR, 3)
    assert len({unknown(DONKEYCAR, seed).servos["steering"].max_us for seed in range(10)}) == 10


def test_some_are_built_in_upside_down() -> None:
    mirrored = {unknown(DONKEYCAR, seed).servos["steering"].max_us < 1500 for seed in range(20)}
    assert mirrored == {True, False}
