"""zteleop: teleoperation that installs in seconds, shows everything, and stops when it must."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from zteleop.bus.node import Node as Node
    from zteleop.bus.session import BusSettings as BusSettings
    from zteleop.compat.pwm_controller import PWMController as PWMController
    from zteleop.messages import Odometry as Odometry
    from zteleop.messages import Pwm as Pwm
    from zteleop.messages import Twist as Twist
    from zteleop.messages import TwistStamped as TwistStamped

_HOMES = {
    "Node": "zteleop.bus.node",
    "BusSettings": "zteleop.bus.session",
    "PWMController": "zteleop.compat.pwm_controller",
}

__all__ = ["BusSettings", "Node", "Odometry", "PWMController", "Pwm", "Twist", "TwistStamped"]


def __getattr__(name: str) -> Any:
    """Import what is asked for, when it is: `zteleop --help` needs neither bus nor messages."""
    home = _HOMES.get(name, "zteleop.messages")
    try:
        return getattr(import_module(home), name)
    except AttributeError:
        raise AttributeError(f"zteleop has no {name!r}") from None
