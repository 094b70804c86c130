"""The Donkeycar nodes' `PWMController`, over the bus: what it says passes gate, mux and limiter.

It is a program as any other: after 0.5 s without a call the channel is neutral again.
"""

from functools import cache
from weakref import WeakKeyDictionary

from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.drivers.registers import prescale, tick_us
from zteleop.errors import BusError, ConfigError
from zteleop.machine import stderr
from zteleop.messages import Channel, Pwm, Vehicle

HEARD_WITHIN = 3.0


class Pair:
    """Steering and throttle of one robot, shared by its controllers: one message moves both channels."""

    def __init__(self, pwms: Publisher[Pwm], vehicle: Vehicle) -> None:
        neutral = {channel.name: channel.neutral_ticks for channel in vehicle.channels}
        if not {"steering", "throttle"} <= neutral.keys():
            raise ConfigError(
                f"PWMController needs the channels steering and throttle, found {', '.join(neutral)}; "
                "publish a Twist on cmd_vel instead"
            )
        self._pwms = pwms
        self.vehicle = vehicle
        self._ticks = {name: neutral[name] for name in ("steering", "throttle")}

    def set_ticks(self, name: str, ticks: int) -> None:
        """Move one channel and leave the other where it is."""
        self._ticks[name] = ticks
        self._pwms.publish(Pwm(self._ticks["steering"], self._ticks["throttle"]))


_pairs: "WeakKeyDictionary[Node, Pair]" = WeakKeyDictionary()


class PWMController:
    """One channel of the robot's chip; `frequency` is the one, in Hz, that the pulses are counted at.

    Without a node, the first controller of a process joins the bus for all of them.
    Raises BusError when no actuator answers, ConfigError when the robot has no such channel.
    """

    def __init__(self, channel: int, frequency: float = 60, *, node: Node | None = None) -> None:
        node = node or _own_node()
        self._pair = _pairs.get(node) or _pairs.setdefault(node, _join(node))
        self._name = _find(self._pair.vehicle, channel).name
        self._scale = tick_us(prescale(frequency)) / self._pair.vehicle.tick_us

    def set_pwm(self, pulse: int) -> None:
        """Set the pulse to so many of the 4096 counts of a period."""
        self._pair.set_ticks(self._name, round(pulse * self._scale))


@cache
def _own_node() -> Node:
    from zteleop import config

    settings = config.load()
    return Node("pwm_controller", settings.robot or config.own_name(), settings.bus)


def _join(node: Node) -> Pair:
    pwms = node.publisher("pwm", Pwm)
    heard = node.membership.heard()
    if not node.membership.until(lambda: heard.beat and heard.vehicle and pwms.matched, HEARD_WITHIN):
        stderr.flush()  # what the log said of it comes first, and the error is the last word
        raise BusError(f"robot {node.robot} does not answer; start zteleop actuator first")
    assert heard.vehicle
    return Pair(pwms, heard.vehicle)


def _find(vehicle: Vehicle, number: int) -> Channel:
    for channel in vehicle.channels:
        if channel.channel == number:
            return channel
    known = ", ".join(f"{channel.name} is {channel.channel}" for channel in vehicle.channels)
    raise ConfigError(f"the robot has no channel {number}; {known}")
