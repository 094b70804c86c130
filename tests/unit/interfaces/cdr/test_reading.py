import random
import struct
from time import thread_time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.interfaces.cdr.values import anything, halves, kinds

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, ros2msg
from zteleop.messages import Message, String

HEADER = b"\0\1\0\0"


def kind_of(*lines: str, **parts: str) -> type[Message]:
    """Return the type that a schema describes."""
    texts = ["\n".join(lines), *(f"{'=' * 80}\nMSG: x/{name}\n{text}" for name, text in parts.items())]
    return ros2msg.struct_of("x/msg/Top", "\n".join(texts))


LYING = [2**31, 2**32 - 1, 2**24]
ARRAYS = ["uint8[]", "bool[]", "int16[]", "float64[]", "string[]", "Part[]", "uint8[<=5000]", "string"]


@pytest.mark.parametrize("array", ARRAYS)
@pytest.mark.parametrize("length", LYING)
def test_a_length_that_lies_is_refused_before_anything_is_made_of_it(array: str, length: int) -> None:
    kind = kind_of(f"{array} items", Part="uint8 x")
    began = thread_time()
    with pytest.raises(MessageError):
        cdr.decode(HEADER + struct.pack("<I", length) + bytes(1000), kind)
    assert thread_time() - began < 0.5


def test_fixed_arrays_of_any_kind_are_read() -> None:
    kind = kind_of("uint8 a", "float64[2] b", "uint8[3] c", "string[2] d", "Part[2] e", Part="int16 x")
    data = HEADER + bytes([7]) + bytes(7) + struct.pack("<2d", 1.5, -2.0) + b"abc" + bytes(1)
    data += struct.pack("<I2s2xI3sx", 2, b"x", 3, b"yz") + struct.pack("<2h", -1, 2)
    assert cdr.decode(data, kind) == cdr.decode(cdr.encode(cdr.decode(data, kind)), kind)
    found = cdr.decode(data, kind)
    assert (found.b, found.c, found.d) == ([1.5, -2.0], b"abc", ["x", "yz"])  # type: ignore[attr-defined]


@pytest.mark.parametrize("items", [0, 1, 2])
def test_nothing_is_aligned_for_no_items(items: int) -> None:
    kind = kind_of("float64[] many", "uint8 after")
    data = HEADER + struct.pack("<I", items) + (bytes(4) + bytes(8 * items) if items else b"") + b"\7"
    assert cdr.decode(data, kind) == kind(many=[0.0] * items, after=7)  # type: ignore[call-arg]
    assert cdr.encode(cdr.decode(data, kind)) == data


def test_a_text_that_is_none_is_refused() -> None:
    with pytest.raises(MessageError, match="utf-8"):
        cdr.decode(HEADER + struct.pack("<I", 3) + b"\xff\xfe\0", String)


def test_a_text_of_no_bytes_is_read_as_others_do() -> None:
    assert cdr.decode(HEADER + struct.pack("<I", 0), String) == String("")
    kind = kind_of("uint8 a", "string[] b", "uint8 c")
    data = HEADER + struct.pack("<B3xIIIB", 255, 2, 0, 0, 7)
    assert cdr.decode(data, kind) == kind(a=255, b=["", ""], c=7)  # type: ignore[call-arg]


@pytest.mark.parametrize("order", ["<", ">"])
def test_a_text_that_does_not_end_with_a_zero_is_refused(order: str) -> None:
    header = HEADER if order == "<" else bytes(4)
    with pytest.raises(MessageError, match="a text does not end with a zero byte"):
        cdr.decode(header + struct.pack(f"{order}I", 3) + b"abc", String)
    with pytest.raises(MessageError, match="a text does not end with a zero byte"):
        cdr.decode(header + struct.pack(f"{order}II", 1, 3) + b"abc", kind_of("string[] x"))


@pytest.mark.parametrize(
    ("field", "data", "found"),
    [
        ("uint8[<=2] x", struct.pack("<I", 3) + b"abc", 3),
        ("float64[<=2] x", struct.pack("<I4x", 3) + bytes(24), 3),
        ("string[<=1] x", struct.pack("<III", 2, 0, 0), 2),
        ("Part[<=1] x", struct.pack("<I", 2) + bytes(2), 2),
        ("string<=2 x", struct.pack("<I", 4) + b"abc\0", 3),
        ("string<=2[] x", struct.pack("<II", 1, 4) + b"abc\0", 3),
    ],
)
def test_more_than_a_type_may_hold_is_refused(field: str, data: bytes, found: int) -> None:
    kind = kind_of(field, Part="uint8 x")
    with pytest.raises(MessageError, match=f"expected at most . characters or items, found {found}"):
        cdr.decode(HEADER + data, kind)


def test_a_fixed_array_that_no_file_can_hold_is_refused() -> None:
    kind = kind_of("float64[400000] x")
    with pytest.raises(MessageError, match="not a x/msg/Top"):
        cdr.decode(HEADER + bytes(1000), kind)


READABLE = [kind for kind in [*kinds(), *halves()] if kind.ros_type != "example_interfaces/msg/WString"]


@given(st.sampled_from(READABLE), st.binary(max_size=200), st.booleans())
def test_any_bytes_are_a_message_or_a_message_error(kind: type[Message], data: bytes, little: bool) -> None:
    try:
        found = cdr.decode(bytes([0, little, 0, 0]) + data, kind)
    except MessageError:
        return
    cdr.encode(found)


@given(st.sampled_from(READABLE), st.integers(0, 2**32), st.floats(0, 1), st.binary(max_size=8))
def test_a_message_with_a_piece_replaced_is_one_or_a_message_error(
    kind: type[Message], seed: int, place: float, piece: bytes
) -> None:
    data = cdr.encode(anything(kind, random.Random(seed)))
    at = round(place * len(data))
    try:
        found = cdr.decode(data[:at] + piece + data[at + len(piece) :], kind)
    except MessageError:
        return
    cdr.encode(found)
