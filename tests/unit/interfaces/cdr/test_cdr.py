import random
import struct
from typing import Any

import pytest
from unit.interfaces.cdr.values import TIMES, anything, halves, kinds

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, ros2msg
from zteleop.interfaces.cdr.runs import CODES
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import Type
from zteleop.interfaces.structs import struct_of
from zteleop.messages import (
    Bool,
    Button,
    Duration,
    Header,
    Int16MultiArray,
    InterfaceButtons,
    Message,
    MultiArrayLayout,
    String,
    Time,
    Twist,
    TwistStamped,
    Vector3,
)

EMPTY, FLOAT, JOY = map(struct_of, ("std_msgs/msg/Empty", "std_msgs/msg/Float64", "sensor_msgs/msg/Joy"))
HEADER = Header(Time(1, 2), "")
PRESSED, RELEASED = (Button(Header(Time(1, 2), "b"), on, Time(3, 4), Duration(5, 6)) for on in (True, False))
MOTION = Twist(Vector3(0.5, 0.0, 0.0), Vector3(0.0, 0.0, -0.25))
BUTTON = "01000000020000000200000062000{}0003000000040000000500000006000000"
GOLDEN: list[tuple[Message, str]] = [
    (
        TwistStamped(Header(Time(1_700_000_000, 123_456_789), "base_link"), MOTION),
        "0001000000f1536515cd5b070a000000626173655f6c696e6b000000000000000000e03f0000000000000000000000000000"
        "000000000000000000000000000000000000000000000000d0bf",
    ),
    (String("hello"), "000100000600000068656c6c6f00"),
    (String(""), "000100000100000000"),
    (Bool(True), "0001000001"),
    (FLOAT(data=1.5), "00010000000000000000f83f"),
    (EMPTY(), "0001000000"),
    (
        Int16MultiArray(MultiArrayLayout([], 0), [1, -2, 3]),
        "000100000000000000000000030000000100feff0300",
    ),
    (
        JOY(header=Header(Time(1, 2), "j"), axes=[0.5, -1.0], buttons=[0, 1]),
        "000100000100000002000000020000006a000000020000000000003f000080bf020000000000000001000000",
    ),
    (
        InterfaceButtons(HEADER, PRESSED, RELEASED, RELEASED),
        "0001000001000000020000000100000000000000" + BUTTON.format(1) + BUTTON.format(0) + BUTTON.format(0),
    ),
]
"""what ROS 2's own code writes"""


@pytest.mark.parametrize(("message", "text"), GOLDEN, ids=lambda value: type(value).__name__)
def test_messages_are_the_bytes_that_ros_2_writes(message: Message, text: str) -> None:
    data = bytes.fromhex(text)
    assert cdr.encode(message) == data
    assert cdr.decode(data, type(message)) == message


def big_endian(message: Message) -> bytes:
    """Return a message in the other order of bytes, all of whose fields are 4 bytes and no text."""
    data = cdr.encode(message)[4:]
    assert len(data) % 4 == 0
    return b"\0\0\0\0" + b"".join(data[at : at + 4][::-1] for at in range(0, len(data), 4))


def test_the_other_order_of_bytes_is_read() -> None:
    for message in (Time(-5, 7), Duration(2**31 - 1, 2**32 - 1)):
        assert cdr.decode(big_endian(message), type(message)) == message
    assert cdr.decode(b"\0\0\0\0\0\0\0\6hello\0", String) == String("hello")
    assert cdr.decode(b"\0\0\0\0" + b"\x3f\xf8" + bytes(6), FLOAT) == FLOAT(data=1.5)


@pytest.mark.parametrize("options", [b"\0\0", b"\0\1", b"\xff\xff"])
def test_the_options_in_the_header_say_nothing(options: bytes) -> None:
    assert cdr.decode(b"\0\1" + options + b"\1", Bool) == Bool(True)


@pytest.mark.parametrize("header", [b"", b"\0", b"\0\1", b"\0\1\0", b"\0\2\0\0", b"\0\7\0\0", b"\1\0\0\0"])
def test_another_header_is_refused(header: bytes) -> None:
    with pytest.raises(MessageError):
        cdr.decode(header + (b"\1" if len(header) > 3 else b""), Bool)


@pytest.mark.parametrize(("message", "text"), GOLDEN, ids=lambda value: type(value).__name__)
def test_a_message_that_is_cut_anywhere_is_refused(message: Message, text: str) -> None:
    data = bytes.fromhex(text)
    for length in range(len(data)):
        with pytest.raises(MessageError):
            cdr.decode(data[:length], type(message))


@pytest.mark.parametrize(("message", "text"), GOLDEN, ids=lambda value: type(value).__name__)
def test_bytes_that_follow_are_padding_or_refused(message: Message, text: str) -> None:
    data = bytes.fromhex(text)
    for more in range(4):
        assert cdr.decode(data + bytes(more), type(message)) == message
    for more in (4, 5, 1000):
        with pytest.raises(MessageError, match=f"expected {len(data)} bytes, found {len(data) + more}"):
            cdr.decode(data + bytes(more), type(message))


def test_every_type_is_read_as_it_was_written() -> None:
    dice = random.Random(1)
    without = [kind for kind in kinds() if not has_words(kind)]
    assert [kind.ros_type for kind in without] == ["example_interfaces/msg/WString"]
    for kind in {*kinds(), *halves()}:
        for message in [anything(kind, dice) for _ in range(TIMES if has_words(kind) else 0)]:
            assert cdr.decode(cdr.encode(message), kind) == message


def test_what_is_read_in_the_other_order_is_the_same() -> None:
    dice = random.Random(2)
    for kind in {*kinds(), *halves()} - {struct_of("example_interfaces/msg/WString")}:
        for message in [anything(kind, dice) for _ in range(TIMES)]:
            assert cdr.decode(turned(message), kind) == message


def turned(message: Message) -> bytes:
    """Return a message in the other order of bytes, one value at a time, as the standard has it."""
    known, body = parts(type(message)), bytearray()

    def add(kind: Type, value: Any) -> None:
        if kind.array:
            if kind.array != "fixed":
                add(Type("uint32"), len(value))
            for item in value:
                add(kind._replace(array=""), item)
        elif code := CODES.get(kind.name):
            body.extend(bytes(-len(body) % struct.calcsize(code)) + struct.pack(f">{code}", value))
        elif kind.name == "string":
            add(Type("uint32"), len(value.encode()) + 1)
            body.extend(value.encode() + b"\0")
        else:
            whole(value, known[kind.name])

    def whole(value: Message, kind: type[Message]) -> None:
        for field in declared(kind).fields:
            add(field.type, getattr(value, field.name))
        if not declared(kind).fields:
            add(Type("uint8"), 0)

    whole(message, type(message))
    return b"\0\0\0\0" + bytes(body)


def has_words(kind: type[Message]) -> bool:
    try:
        cdr.encoder(kind)
    except MessageError:
        return False
    return True


def test_a_type_for_which_there_is_no_word_is_refused() -> None:
    kind = struct_of("example_interfaces/msg/WString")
    for make in (cdr.encoder, cdr.decoder):
        with pytest.raises(MessageError, match="holds a wstring"):
            make(kind)


def test_nor_is_one_within_another() -> None:
    schema = "W w\n" + "=" * 80 + "\nMSG: a/W\nwstring w\n"
    with pytest.raises(MessageError, match="holds a wstring"):
        cdr.decoder(ros2msg.struct_of("a/msg/B", schema))
