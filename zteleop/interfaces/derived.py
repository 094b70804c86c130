"""What ROS makes of the parts of a service or an action: the messages and services in which they travel.

An action is asked for with two services, SendGoal and GetResult, and tells how it goes in a FeedbackMessage.
Every service has an event, which tells those who watch it that it was called. (rosidl_parser)
"""

from collections.abc import Iterator

from zteleop.interfaces.msg_text import Definition, Field, Type
from zteleop.messages.service import REQUEST, RESPONSE

EVENT = "_Event"
SEND_GOAL, GET_RESULT, FEEDBACK = "_SendGoal", "_GetResult", "_FeedbackMessage"
SERVICES = {"msg": (), "srv": ("",), "action": (SEND_GOAL, GET_RESULT)}
"""by kind: what stands behind the name of an interface in those of its services"""
ENDS: dict[str, tuple[str, ...]] = {
    "msg": (),
    "srv": (EVENT,),
    "action": (
        FEEDBACK,
        *(service + end for service in SERVICES["action"] for end in ("", REQUEST, RESPONSE, EVENT)),
    ),
}
"""by kind: what stands behind the name of an interface in the types that come of it"""
_UUID, _TIME = "unique_identifier_msgs/msg/UUID", "builtin_interfaces/msg/Time"
_INFO = "service_msgs/msg/ServiceEventInfo"


def messages(interface: str) -> Iterator[Definition]:
    """Yield the messages that come of std_srvs/srv/SetBool or x/action/Dock, besides its own parts."""
    kind = interface.split("/")[1]
    if kind == "action":
        yield from _of_action(interface)
    for end in SERVICES[kind]:
        yield _event(interface + end)


def wholes(interface: str) -> Iterator[Definition]:
    """Yield each service of an interface, and an action itself, as messages that hold their parts.

    None of them travels; their type has a description and a hash all the same.
    """
    kind = interface.split("/")[1]
    for end in SERVICES[kind]:
        yield _service(interface + end)
    if kind == "action":
        yield _definition(
            interface,
            goal=f"{interface}_Goal",
            result=f"{interface}_Result",
            feedback=f"{interface}_Feedback",
            send_goal_service=interface + SEND_GOAL,
            get_result_service=interface + GET_RESULT,
            feedback_message=interface + FEEDBACK,
        )


def _of_action(name: str) -> Iterator[Definition]:
    yield _definition(name + SEND_GOAL + REQUEST, goal_id=_UUID, goal=f"{name}_Goal")
    yield _definition(name + SEND_GOAL + RESPONSE, accepted="bool", stamp=_TIME)
    yield _definition(name + GET_RESULT + REQUEST, goal_id=_UUID)
    yield _definition(name + GET_RESULT + RESPONSE, status="int8", result=f"{name}_Result")
    yield _definition(name + FEEDBACK, goal_id=_UUID, feedback=f"{name}_Feedback")


def _service(name: str) -> Definition:
    ends = (REQUEST, RESPONSE, EVENT)
    return _definition(name, **{f"{end[1:].lower()}_message": name + end for end in ends})


def _event(name: str) -> Definition:
    halves = {"request": name + REQUEST, "response": name + RESPONSE}
    fields = [Field(Type(half, None, "bounded", 1), field) for field, half in halves.items()]
    return Definition(name + EVENT, (Field(Type(_INFO), "info"), *fields), ())


def _definition(ros_type: str, **fields: str) -> Definition:
    return Definition(ros_type, tuple(Field(Type(kind), name) for name, kind in fields.items()), ())
