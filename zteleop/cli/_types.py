"""Types by their names: those that come along, those of ROS, and those that somebody on the bus speaks."""

from collections.abc import Sequence

from zteleop.bus.session import open_session
from zteleop.bus.settings import BusSettings
from zteleop.bus.types import ask_type
from zteleop.errors import MessageError
from zteleop.messages import SERVICES, Message, is_called, message_type


def find_type(name: str, bus: BusSettings) -> type[Message]:
    """Return the type of that name, and ask on the bus only where nobody here knows it.

    As C++ and Python write it, `geometry_msgs::msg::Twist` and `geometry_msgs.msg.Twist`, it is the same.
    Raises MessageError with the nearest names where nobody there does either.
    """
    if name and not (name[0].isalpha() or name[0] == "_"):  # values, where their type was left out
        raise MessageError(f"expected a type before the values, such as Twist, found {name!r:.60}")
    name = name.replace("::", "/").replace(".", "/")
    try:
        return message_type(name)
    except MessageError as error:
        unknown = error
    if found := _of_ros(name):
        return found
    if "/" in name or name[:1].isupper():
        with open_session(bus, settle=True) as session:
            if told := ask_type(session, name):
                return told
    raise MessageError(f"{unknown} (and nobody on the bus speaks it)")


def service_of(name: str) -> Sequence[type[Message]]:
    """Return request and response of the service of that name; nothing where it is none."""
    return next((halves for ros_type, halves in SERVICES.items() if is_called(ros_type, name)), ())


def _of_ros(name: str) -> type[Message] | None:
    """Return a type that ROS has, and that is known by its text alone."""
    from zteleop.interfaces import library, structs  # only for a type that is not one of ours

    package, *rest = name.split("/")
    full = f"{package}/msg/{rest[-1]}" if rest else ""
    return structs.struct_of(full) if full and library.has(full) else None
