import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from rig import NEUTRAL, Rig, repeating, until

from zteleop.messages import Twist

pytest_plugins = ["judging", "leaks"]
# What runs in a shell's background, or by nohup, ignores these, and so would all that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGQUIT, signal.SIG_DFL)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
# How many examples of each claim about anything at all: `make soak` asks for the long one.
settings.register_profile("short", deadline=None, max_examples=25)
settings.register_profile("long", deadline=None, max_examples=1000)
settings.load_profile("short")


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        yield bench


@pytest.fixture
def driving(rig: Rig) -> Iterator[None]:
    """Start the robot, and drive it by a program that says so 50 times a second, whatever happens."""
    rig.actuator()
    node = rig.node("driver")
    rig.hear(node)
    motors = node.publisher("cmd_vel", Twist)
    with repeating(lambda: motors.publish(Twist.planar(0.5)), 0.02):
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 10, "the throttle above neutral")
        yield
