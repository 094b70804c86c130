"""A bus that is slow is a fault in words that name it: no lasting stop, nobody killed, nobody else blamed."""

import pytest
from bench import FORWARD, STREAM
from rig import NEUTRAL, Rig, every, hear, repeating, until

from zteleop.drivers.faults import Faults
from zteleop.messages import DriveStatus, WatchdogStatus

SPELL = 2.0


@pytest.mark.parametrize("ms", [60, 100])
def test_a_slow_spell_of_the_bus_stops_a_robot_for_as_long_as_it_lasts(rig: Rig, ms: int) -> None:
    actuator = rig.actuator()
    node, looker = rig.node("driver"), rig.node("looker")
    rig.hear(node)
    motors = node.publisher("pwm", type(FORWARD), source="keyboard")
    statuses = looker.subscription("drive_status", DriveStatus)
    dogs = looker.subscription("watchdog", WatchdogStatus)
    with Faults(rig.chip) as faults, repeating(lambda: motors.publish(FORWARD), STREAM):
        until(lambda: rig.ticks != NEUTRAL, "pulses that move")
        faults.slow(ms)
        status = hear(statuses, lambda status: status.state == "fault", "a fault")
        assert status.why.startswith("its bus is slow: a write took ")
        until(lambda: rig.ticks == NEUTRAL, "neutral on the chip")
        for _ in every(0.01, round(SPELL / 0.01)):
            assert rig.ticks == NEUTRAL
        faults.slow(0)
        status = hear(statuses, lambda status: status.state == "idle", "a bus that is quick again")
        assert status.stops == []
        assert hear(dogs, lambda dog: dog.state == "watching", "its watchdog").restarts == 0
        assert rig.ticks == NEUTRAL, "a stream from before moves it"
        assert "stops the robot" not in actuator.text
    motors.let_go()
    with repeating(lambda: motors.publish(FORWARD), STREAM):
        until(lambda: rig.ticks != NEUTRAL, "somebody who begins anew")
