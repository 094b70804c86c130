"""A person at a terminal who goes away, or whose terminal ends."""

import signal

from rig import NEUTRAL, Rig, Terminal, until
from verdict import Deadline

UP, LEFT = "\x1b[A", "\x1b[D"


def pressed(rig: Rig) -> Terminal:
    """Start a robot and a keyboard, and press two keys."""
    rig.actuator()
    keyboard = rig.keyboard()
    keyboard.shows(" idle")
    keyboard.type(LEFT + UP)
    until(lambda: rig.ticks == (390, 374), "levers on the chip")
    return keyboard


def test_five_seconds_without_a_key_bring_steering_and_throttle_to_neutral(rig: Rig) -> None:
    pressed(rig)
    Deadline(rig).met(lambda: rig.ticks == NEUTRAL, "neutral", 5.1, not_before=4.8)


def test_a_keyboard_that_is_told_to_end_lets_go_before_its_silence_would(rig: Rig) -> None:
    keyboard = pressed(rig)
    deadline = Deadline(rig)
    keyboard.signal(signal.SIGTERM)
    deadline.met(lambda: rig.ticks == NEUTRAL, "neutral", 0.1)
