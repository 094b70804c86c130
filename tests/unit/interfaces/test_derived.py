import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, library
from zteleop.interfaces.derived import messages, wholes
from zteleop.interfaces.library import definition, described
from zteleop.interfaces.msg_text import Type
from zteleop.interfaces.structs import struct_of
from zteleop.messages import MESSAGES, REQUEST, RESPONSE, Time
from zteleop.messages.message import field_types

DOCK = "irobot_create_msgs/action/Dock"
SET_BOOL = "std_srvs/srv/SetBool"
INTERFACES = [
    f"{package}/{kind}/{leaf}"
    for package in library.packages()
    for kind in ("srv", "action")
    for leaf in library.types(package, kind)
]


def shape(ros_type: str) -> list[tuple[str, str]]:
    return [(field.name, field.type.name) for field in definition(ros_type).fields]


@pytest.mark.parametrize(
    ("end", "fields"),
    [
        ("_SendGoal_Request", [("goal_id", "unique_identifier_msgs/msg/UUID"), ("goal", f"{DOCK}_Goal")]),
        ("_SendGoal_Response", [("accepted", "bool"), ("stamp", "builtin_interfaces/msg/Time")]),
        ("_GetResult_Request", [("goal_id", "unique_identifier_msgs/msg/UUID")]),
        ("_GetResult_Response", [("status", "int8"), ("result", f"{DOCK}_Result")]),
        (
            "_FeedbackMessage",
            [("goal_id", "unique_identifier_msgs/msg/UUID"), ("feedback", f"{DOCK}_Feedback")],
        ),
    ],
)
def test_an_action_travels_in_these_messages(end: str, fields: list[tuple[str, str]]) -> None:
    assert shape(DOCK + end) == fields
    assert struct_of(DOCK + end).ros_type == DOCK + end


@pytest.mark.parametrize("service", [SET_BOOL, f"{DOCK}_SendGoal", f"{DOCK}_GetResult"])
def test_a_service_has_an_event_of_at_most_one_request_and_response(service: str) -> None:
    info, *halves = definition(f"{service}_Event").fields
    assert (info.name, info.type.name) == ("info", "service_msgs/msg/ServiceEventInfo")
    assert [(half.name, half.type) for half in halves] == [
        ("request", Type(service + REQUEST, None, "bounded", 1)),
        ("response", Type(service + RESPONSE, None, "bounded", 1)),
    ]


def test_whatever_comes_of_an_interface_is_a_struct_that_travels() -> None:
    for found in (message for interface in INTERFACES for message in messages(interface)):
        kind = struct_of(found.ros_type)
        assert cdr.decode(cdr.encode(kind.zero()), kind) == kind.zero()


def test_a_goal_is_sent_as_ros_2_sends_it() -> None:
    kind = struct_of("irobot_create_msgs/action/DriveDistance_SendGoal_Request")
    inner = field_types(kind)
    identity = inner["goal_id"](uuid=bytes(range(16)))
    goal = inner["goal"](distance=0.5, max_translation_speed=0.25)
    wanted = "00010000" + bytes(range(16)).hex() + "0000003f0000803e"
    assert cdr.encode(kind(goal_id=identity, goal=goal)).hex() == wanted  # type: ignore[call-arg]


def test_an_answer_to_it_holds_our_own_time() -> None:
    kind = struct_of(f"{DOCK}_SendGoal_Response")
    answer = cdr.decode(bytes.fromhex("00010000010000000500000007000000"), kind)
    assert answer == kind(accepted=True, stamp=Time(5, 7))  # type: ignore[call-arg]


def test_a_goal_without_fields_is_one_byte_behind_the_identity() -> None:
    kind = struct_of("irobot_create_msgs/action/Undock_SendGoal_Request")
    assert len(cdr.encode(kind.zero())) == 4 + 16 + 1


@pytest.mark.parametrize(
    ("whole", "parts"),
    [
        (SET_BOOL, "std_srvs/srv/SetBool_Request or std_srvs/srv/SetBool_Response"),
        (DOCK, f"{DOCK}_Goal or {DOCK}_Result or {DOCK}_Feedback"),
        (f"{DOCK}_SendGoal", f"{DOCK}_SendGoal_Request or {DOCK}_SendGoal_Response"),
    ],
)
def test_a_whole_is_no_message_and_its_parts_are_told(whole: str, parts: str) -> None:
    with pytest.raises(MessageError) as error:
        definition(whole)
    assert str(error.value) == f"{whole} is more than one message; ask for {parts}"


def test_but_it_is_described_as_one() -> None:
    assert [field.name for field in described(SET_BOOL).fields] == [
        "request_message",
        "response_message",
        "event_message",
    ]
    assert [(field.name, field.type.name) for field in described(DOCK).fields] == [
        ("goal", f"{DOCK}_Goal"),
        ("result", f"{DOCK}_Result"),
        ("feedback", f"{DOCK}_Feedback"),
        ("send_goal_service", f"{DOCK}_SendGoal"),
        ("get_result_service", f"{DOCK}_GetResult"),
        ("feedback_message", f"{DOCK}_FeedbackMessage"),
    ]
    assert described("std_msgs/msg/Bool") == definition("std_msgs/msg/Bool")


def test_nothing_comes_of_a_message() -> None:
    assert not [*messages("std_msgs/msg/Bool"), *wholes("std_msgs/msg/Bool")]
    for wrong in ("std_msgs/msg/Bool_Event", "std_msgs/msg/Bool_SendGoal_Request", "x/srv/Y_Event"):
        with pytest.raises(MessageError, match=r"no interface|no package"):
            definition(wrong)


def test_a_half_that_is_our_own_struct_is_so_within_the_event() -> None:
    kind = struct_of(f"{SET_BOOL}_Event")
    (request, response) = (MESSAGES[SET_BOOL + end] for end in (REQUEST, RESPONSE))
    filled = kind.zero()
    filled.request, filled.response = [request(True)], [response(True, "on")]  # type: ignore[attr-defined, call-arg]
    assert cdr.decode(cdr.encode(filled), kind) == filled
