"""A person at a terminal who goes away, or whose terminal ends."""

import signal

from rig import NEUTRAL, Rig, Terminal, repeating, until
from verdict import Deadline

UP, LEFT, RIGHT = "\x1b[A", "\x1b[D", "\x1b[C"
STEERED = 20
"""ticks from straight ahead"""
REVERSED = 0.15
"""s from the other key to the other way"""


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


def test_the_other_way_is_steered_at_once_when_it_is_pressed_while_the_first_is_held(rig: Rig) -> None:
    rig.actuator()
    told = rig.keyboard("--drive", "hold", tells_releases=True)
    told.shows("nobody operates", "release told")
    told.key("left")
    until(lambda: rig.ticks[0] > NEUTRAL[0] + STEERED, "wheels to the left")
    deadline = Deadline(rig)
    told.key("right")
    deadline.met(lambda: rig.ticks[0] < NEUTRAL[0] - STEERED, "wheels to the right", REVERSED)
    told.key("q")
    assert told.ends() == 0


def test_the_other_way_is_steered_at_once_where_releases_are_guessed(rig: Rig) -> None:
    rig.actuator()
    guessed = rig.keyboard("--drive", "hold")
    guessed.shows("nobody operates", "release guessed")
    with repeating(lambda: guessed.type(LEFT), 0.04):
        until(lambda: rig.ticks[0] > NEUTRAL[0] + STEERED, "wheels to the left")
    deadline = Deadline(rig)
    guessed.type(RIGHT)
    deadline.met(lambda: rig.ticks[0] < NEUTRAL[0] - STEERED, "wheels to the right", REVERSED)
