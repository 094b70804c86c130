import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import field_ids
from zteleop.interfaces.field_ids import read, told
from zteleop.interfaces.library import definition
from zteleop.interfaces.msg_text import PLAIN, Type

VECTOR = "geometry_msgs/msg/Vector3"


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        (Type("int8"), (2, 0, 0, "")),
        (Type("float64", None, "fixed", 36), (11 + 48, 36, 0, "")),
        (Type("bool", None, "bounded", 5), (15 + 96, 5, 0, "")),
        (Type("byte", None, "unbounded"), (16 + 144, 0, 0, "")),
        (Type("string"), (17, 0, 0, "")),
        (Type("string", 255), (21, 0, 255, "")),
        (Type("string", 4, "bounded", 2), (21 + 96, 2, 4, "")),
        (Type("wstring"), (18, 0, 0, "")),
        (Type("wstring", 9, "unbounded"), (22 + 144, 0, 9, "")),
        (Type(VECTOR), (1, 0, 0, VECTOR)),
        (Type(VECTOR, None, "fixed", 2), (49, 2, 0, VECTOR)),
        (Type(VECTOR, None, "unbounded"), (145, 0, 0, VECTOR)),
    ],
)
def test_a_type_is_told_by_these_numbers_and_read_from_them(
    kind: Type, numbers: tuple[int, int, int, str]
) -> None:
    assert told(kind) == numbers
    assert read(*numbers) == kind


def test_a_char_is_told_as_a_uint8_and_read_where_another_tells_of_one() -> None:
    assert told(Type("char", None, "fixed", 16)) == (3 + 48, 16, 0, "")
    assert read(13, 0, 0, "") == Type("char")


def test_every_plain_type_has_the_number_that_ros_gives_it() -> None:
    words = {"bool": "BOOLEAN", "float32": "FLOAT", "float64": "DOUBLE", "char": "UINT8"}
    constants = definition("type_description_interfaces/msg/FieldType").constants
    numbers = {constant.name: constant.value for constant in constants}
    for name in PLAIN:
        assert told(Type(name)).type_id == numbers[f"FIELD_TYPE_{words.get(name, name.upper())}"]
    assert numbers["FIELD_TYPE_NESTED_TYPE"] == field_ids.NESTED


@pytest.mark.parametrize(
    ("numbers", "why"),
    [
        ((0, 0, 0, ""), "a field of the type with the number 0 is not read here"),
        ((12, 0, 0, ""), "number 12 is not read"),
        ((14, 0, 0, ""), "number 14 is not read"),
        ((19, 0, 8, ""), "number 19 is not read"),
        ((47, 0, 0, ""), "number 47 is not read"),
        ((192, 0, 0, ""), "no type of a field has the number 192"),
        ((255, 0, 0, ""), "no type of a field has the number 255"),
        ((1, 0, 0, ""), "number 1 is not read"),
        ((1, 0, 0, "int8"), "number 1 is not read"),
        ((2 + 48, 0, 0, ""), "expected a length from 1 to 4294967295, found 0"),
        ((2 + 96, 2**32, 0, ""), "expected a length from 1 to 4294967295, found 4294967296"),
        ((21, 0, 0, ""), "expected a length from 1"),
        ((22, 0, 2**64 - 1, ""), "expected a length from 1"),
    ],
)
def test_other_numbers_are_none(numbers: tuple[int, int, int, str], why: str) -> None:
    with pytest.raises(MessageError, match=why):
        read(*numbers)
