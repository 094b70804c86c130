"""What strangers say on an open bus costs nobody his drive."""

import time

import pytest
import zenoh
from rig import NEUTRAL, Rig, repeating, until

from zteleop.control.deadlines import DEAF_AFTER

RATE = 0.02
DROP = zenoh.CongestionControl.DROP


@pytest.mark.usefixtures("driving")
def test_bytes_that_are_no_beat_take_no_beats_place(rig: Rig) -> None:
    beats = rig.session().declare_publisher("robot/bench/beat", congestion_control=DROP)

    def flood() -> None:
        beats.put(b"twenty bytes of none", encoding="application/json;zteleop_msgs/msg/Beat")

    with repeating(flood, 0.001):
        time.sleep(DEAF_AFTER + 1.0)  # by then whoever misses the beats has noticed
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 10, "a robot that is driven on")
