"""Any keys at any pace, on any vehicle: a stick in range, and commands within the calibration."""

from math import isfinite
from typing import Literal

from hypothesis import given, settings
from hypothesis import strategies as st

from zteleop.control.mixer import Differential
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.stick import to_pwm, to_twist
from zteleop.inputs.keyboard import Keyboard
from zteleop.inputs.levers import Steps
from zteleop.testing import FakeTerminal

CAR = to_vehicle(DriveSettings(), 4.08)
REVERSED = to_vehicle(
    DriveSettings(
        servos={"throttle": Servo(channel=0), "steering": Servo(channel=1, min_us=2000, max_us=1000)}
    ),
    4.08,
)
TANK = to_vehicle(
    DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)
ARROWS = [b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D"]
KEYS = [*ARROWS, *(bytes([key]) for key in b"wasdijklu qz+-")]
PRESSES = st.lists(
    st.tuples(st.one_of(st.sampled_from(KEYS), st.binary(max_size=3)), st.floats(0, 0.6), st.integers(1, 40)),
    max_size=12,
)


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from(["step", "hold"]),
    st.sampled_from([CAR, REVERSED, TANK]),
    st.integers(1, 4095),
    PRESSES,
)
def test_any_keys_are_a_stick_in_range(
    drive: Literal["step", "hold"], vehicle: object, step: int, presses: list[tuple[bytes, float, int]]
) -> None:
    vehicle = CAR if drive == "step" and vehicle is TANK else vehicle
    terminal, now = FakeTerminal(), 100.0
    keyboard = Keyboard(drive, steps=Steps(step, step), terminal=terminal)
    keyboard.fit(vehicle)
    for key, wait, times in presses:
        now += wait
        terminal.typed = key * times
        keyboard.read(now)
        stick = keyboard.stick(now)
        assert -1 <= stick.forward <= 1
        assert -1 <= stick.turn <= 1
        assert stick.deadman or (stick.forward, stick.turn) == (0.0, 0.0)
        twist = to_twist(stick, keyboard.speeds, vehicle)
        assert twist is None or (isfinite(twist.angular.z) and abs(twist.linear.x) <= vehicle.max_speed)
        if drive == "step" and (pwm := to_pwm(stick, vehicle)):
            asked = (pwm.throttle_ticks, pwm.steering_ticks)
            for channel, ticks in zip(vehicle.channels, asked, strict=True):
                low, high = sorted((channel.min_ticks, channel.max_ticks))
                assert low <= ticks <= high
