"""A stop reaches the chip at once, from a key and from a program, whoever goes on driving."""

from rig import NEUTRAL, Rig, repeating, until
from verdict import Deadline

from zteleop.messages import Stop, Twist

UP, LEFT, DELETE = "\x1b[A", "\x1b[D", "\x7f"
AT_ONCE = 0.03
STREAM = 0.02


def test_a_stop_that_is_pressed_brings_neutral_at_once(rig: Rig) -> None:
    rig.actuator()
    keyboard = rig.keyboard()
    keyboard.shows(" idle")
    keyboard.type(LEFT + UP)
    until(lambda: rig.ticks == (390, 374), "levers on the chip")
    deadline = Deadline(rig)
    keyboard.type(DELETE)
    deadline.met(lambda: rig.ticks == NEUTRAL, "neutral on the chip", AT_ONCE)
    keyboard.shows("● stopped", "bench is stopped (neutral read back from the chip")


def test_a_stop_that_is_said_brings_neutral_at_once_under_whoever_goes_on_driving(rig: Rig) -> None:
    rig.actuator()
    node = rig.node()
    rig.hear(node)
    motors, stops = node.publisher("cmd_vel", Twist), node.publisher("stop", Stop)
    until(lambda: stops.matched, "somebody who hears stops")
    with repeating(lambda: motors.publish(Twist.planar(0.5)), STREAM):
        until(lambda: rig.ticks[1] > NEUTRAL[1], "the throttle above neutral")
        deadline = Deadline(rig)
        stops.publish(Stop(True, 7, "ann", ""))
        deadline.met(lambda: rig.ticks == NEUTRAL, "neutral on the chip", AT_ONCE)
