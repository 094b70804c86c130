"""The battery of a simulated car or tank: it runs down as it drives, and its motors get weaker with it."""

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.messages import BatteryState, Header
from zteleop.sim.battery import Battery
from zteleop.sim.body import Body

AT_REST, PER_SPEED = 4.0, 15.0
"""W that it draws, a Raspberry Pi's, and W more for each m/s"""
EVERY = 1.0
LOW = 0.2
"""of its charge, from which on it is time to stop"""


def give_power(node: Node, vehicle: Body, battery: Battery) -> None:
    """Let a vehicle draw on a battery, and say how that is."""
    told = node.publisher("battery_state", BatteryState)
    warned = ""

    @node.every(EVERY)
    def draw() -> None:
        nonlocal warned
        battery.draw(AT_REST + PER_SPEED * abs(vehicle.speed), EVERY)
        vehicle.power = battery.strength
        told.publish(battery.state(Header(clock.stamp(), "base_link")))
        if (words := state_of(battery)) != warned:
            warned = words
            anew = "start the simulator anew, without --charge, for a full one"
            node.log.warn(f"{node.robot}'s battery {words}; {anew}")


def state_of(battery: Battery) -> str:
    """Return what somebody should know of it; nothing while all is well."""
    if battery.percentage > LOW:
        return ""
    return "is low" if battery.percentage > 0 else "is empty, and its motors stand"
