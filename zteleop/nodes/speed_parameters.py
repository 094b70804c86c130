"""What a full stick means as parameters of an input: others change it, and see what keys make of it."""

from collections.abc import Callable

from msgspec.structs import replace

from zteleop.bus.node import Node
from zteleop.inputs import Input

FASTEST = 100.0
"""m/s, or rad/s; what a robot can is less, and bounds it"""
FOLLOW_EVERY = 0.5
"""s"""


def offer_speeds(node: Node, device: Input) -> None:
    """Let others read and change a device's speeds while it drives."""

    def changes(name: str) -> Callable[[float], None]:
        def change(value: float) -> None:
            device.speeds = replace(device.speeds, **{name: value})

        return change

    offered = {
        name: node.parameter(
            f"speeds.{name}",
            float(getattr(device.speeds, name)),
            words,
            least=0.0,
            most=FASTEST,
            changed=changes(name),
        )
        for name, words in (("forward", "m/s of a full stick"), ("turn", "rad/s of a full stick"))
    }

    @node.every(FOLLOW_EVERY)
    def follow() -> None:
        for name, parameter in offered.items():
            parameter.value = float(getattr(device.speeds, name))
