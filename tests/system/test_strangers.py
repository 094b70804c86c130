"""What strangers say on an open bus costs nobody his drive."""

import time
from collections.abc import Iterator

import pytest
import zenoh
from rig import NEUTRAL, Rig, repeating, until

from zteleop.control.deadlines import DEAF_AFTER
from zteleop.messages import Twist

RATE = 0.02
DROP = zenoh.CongestionControl.DROP


@pytest.fixture
def driving(rig: Rig) -> Iterator[None]:
    """A program that drives; it says so 50 times a second."""
    rig.actuator()
    node = rig.node("driver")
    rig.hear(node)
    motors = node.publisher("cmd_vel", Twist)
    with repeating(lambda: motors.publish(Twist.planar(0.5)), RATE):
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 10, "the throttle above neutral")
        yield


@pytest.mark.usefixtures("driving")
def test_bytes_that_are_no_beat_take_no_beats_place(rig: Rig) -> None:
    beats = rig.session().declare_publisher("robot/bench/beat", congestion_control=DROP)

    def flood() -> None:
        beats.put(b"twenty bytes of none", encoding="application/json;zteleop_msgs/msg/Beat")

    with repeating(flood, 0.001):
        time.sleep(DEAF_AFTER + 1.0)  # by then whoever misses the beats has noticed
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 10, "a robot that is driven on")
