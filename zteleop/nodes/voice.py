"""What an operator's input says to a robot: ticks while it drives in steps, else a twist."""

from typing import Any

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.control.proof import called
from zteleop.control.stick import neutral_pwm
from zteleop.inputs import Input
from zteleop.messages import Header, Pwm, Twist, TwistStamped, Vehicle


class Voice:
    """Both publishers of one device; how it is driven can change while it speaks."""

    def __init__(self, node: Node, device: Input, source: str) -> None:
        self._device = device
        self._source = source
        self._twists = node.publisher("cmd_vel", TwistStamped, source=source, wait=False)
        self._pwms = node.publisher("pwm", Pwm, source=source, wait=False)

    @property
    def publisher(self) -> Publisher[Any]:
        """The one that speaks now."""
        return self._pwms if self._device.drive == "step" else self._twists

    @property
    def name(self) -> str:
        """What everything calls it: `keyboard 18d4`."""
        return called(self._source, self.publisher.sender)

    def act(self) -> None:
        """Note that the operator acted."""
        self._twists.act()
        self._pwms.act()

    def say(self, command: Twist | Pwm | None, vehicle: Vehicle) -> None:
        """Say a command, or neutral where there is none."""
        message: TwistStamped | Pwm
        if self._device.drive == "step":
            message = command if isinstance(command, Pwm) else neutral_pwm(vehicle)
        else:
            twist = command if isinstance(command, Twist) else Twist.planar()
            message = TwistStamped(Header(clock.stamp(), "base_link"), twist)
        publisher = self.publisher
        (publisher.repeat if command else publisher.rest)(message)
