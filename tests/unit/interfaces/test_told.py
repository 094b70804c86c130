import pytest

from zteleop.errors import MessageError
from zteleop.interfaces.library import definition
from zteleop.interfaces.msg_text import Definition, Field, Type, parse_message
from zteleop.interfaces.told import LARGEST, MOST_VALUES, struct_told
from zteleop.messages import Header, String, Time
from zteleop.messages.message import field_types

TOP = "garden_msgs/msg/Top"


def told(**texts: str) -> dict[str, Definition]:
    names = {leaf: f"garden_msgs/msg/{leaf}" for leaf in texts}
    return {names[leaf]: parse_message(text, names[leaf]) for leaf, text in texts.items()}


def test_our_own_struct_is_it_where_both_say_the_same() -> None:
    assert (
        struct_told("std_msgs/msg/String", {"std_msgs/msg/String": definition("std_msgs/msg/String")})
        is String
    )


def test_what_is_left_out_is_as_the_library_has_it() -> None:
    kind = struct_told(TOP, told(Top="std_msgs/Header header\nsensor_msgs/JoyFeedback feedback"))
    assert field_types(kind)["header"] is Header
    assert field_types(kind)["feedback"].__struct_fields__ == ("type", "id", "intensity")


def test_one_within_that_is_told_otherwise_changes_all_around_it() -> None:
    time = Definition("builtin_interfaces/msg/Time", (Field(Type("int32"), "secs"),), ())
    kind = struct_told(
        "std_msgs/msg/Header", {"std_msgs/msg/Header": definition("std_msgs/msg/Header"), time.ros_type: time}
    )
    assert kind is not Header
    assert field_types(kind)["stamp"] is not Time
    assert field_types(kind)["stamp"].__struct_fields__ == ("secs",)


def test_what_nobody_tells_is_named() -> None:
    with pytest.raises(MessageError, match=f"of {TOP} does not say what garden_msgs/msg/Pot is"):
        struct_told(TOP, told(Top="Pot pot"))


@pytest.mark.parametrize(
    ("fields", "found"),
    [
        ("\n".join(f"int8 x{n}" for n in range(MOST_VALUES + 1)), MOST_VALUES + 1),
        (f"int8[{LARGEST + 1}] x", LARGEST + 1),
    ],
    ids=["wide", "long"],
)
def test_a_type_of_too_many_values_is_refused(fields: str, found: int) -> None:
    with pytest.raises(MessageError, match=f"{TOP} has more values than are read: {found}"):
        struct_told(TOP, told(Top=fields))


def test_a_list_that_may_be_empty_counts_for_nothing() -> None:
    kind = struct_told(TOP, told(Top="Pot[] pots\nPot[<=9] few", Pot=f"int8[{LARGEST}] x"))
    assert kind.zero() == kind(pots=[], few=[])  # type: ignore[call-arg]
