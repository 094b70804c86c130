"""The Donkeycar nodes' `PWMController`, over the bus: what it says passes mux, gate and limiter.

It is a program as any other: after 0.5 s without a call the channel is neutral again.
"""

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.drivers.registers import prescale, tick_us
from zteleop.errors import BusError, ConfigError
from zteleop.messages import Channel, Pwm, Vehicle

PATIENCE = 3.0


class Wheel:
    """One process's hand on one robot, shared by its controllers: one message moves both channels."""

    shared: "Wheel | None" = None

    def __init__(self, node: Node) -> None:
        self._node = node
        self._pwms = node.publisher("pwm", Pwm)
        self.vehicle = self._await_vehicle()
        neutral = {channel.name: channel.neutral_ticks for channel in self.vehicle.channels}
        self._ticks = {name: neutral[name] for name in ("steering", "throttle")}

    def set_ticks(self, name: str, ticks: int) -> None:
        """Move one channel and leave the other where it is."""
        self._ticks[name] = ticks
        self._pwms.publish(Pwm(self._ticks["steering"], self._ticks["throttle"]))

    def _await_vehicle(self) -> Vehicle:
        give_up = clock.now() + PATIENCE
        while clock.now() < give_up:
            heard = self._node.heard()
            heard.listen()
            if heard.beat and heard.vehicle and self._pwms.heard:
                return heard.vehicle
            self._node.spin(0.01)
        raise BusError(f"robot {self._node.robot} does not answer; start zteleop actuator first")


class PWMController:
    """One channel of the robot's chip; `frequency` is the one, in Hz, that the pulses are counted at.

    Within one process the first controller joins the bus; `node` joins it some other way.
    Raises BusError when no actuator answers, ConfigError when the robot has no such channel.
    """

    def __init__(self, channel: int, frequency: float = 60, *, node: Node | None = None) -> None:
        if node:
            Wheel.shared = Wheel(node)
        self._wheel = Wheel.shared = Wheel.shared or Wheel(_join())
        self._channel = _find(self._wheel.vehicle, channel)
        self._tick_us = tick_us(prescale(frequency))

    def set_pwm(self, pulse: int) -> None:
        """Set the pulse to so many of the 4096 counts of a period."""
        robot_tick_us = self._channel.neutral_us / self._channel.neutral_ticks
        self._wheel.set_ticks(self._channel.name, round(pulse * self._tick_us / robot_tick_us))


def _join() -> Node:
    from zteleop import config

    settings = config.load()
    return Node("pwm_controller", settings.robot or config.own_name(), settings.bus)


def _find(vehicle: Vehicle, number: int) -> Channel:
    for channel in vehicle.channels:
        if channel.channel == number:
            return channel
    known = ", ".join(f"{channel.name} is {channel.channel}" for channel in vehicle.channels)
    raise ConfigError(f"the robot has no channel {number}; {known}")
