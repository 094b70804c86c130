"""Every type there is, by two libraries that others have written, both ways."""

import random
from functools import cache
from typing import Any

import pytest
from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from unit.interfaces.cdr.values import TIMES, anything, kinds

from zteleop.interfaces import cdr, ros2msg
from zteleop.messages import Message

KINDS = [
    kind for kind in kinds() if "/msg/" in kind.ros_type and kind.ros_type != "example_interfaces/msg/WString"
]


def same(ours: Any, theirs: Any) -> bool:
    if isinstance(ours, Message):
        return all(same(getattr(ours, name), getattr(theirs, name)) for name in ours.__struct_fields__)
    if isinstance(ours, list):
        return len(ours) == len(theirs) and all(map(same, ours, theirs))
    return bool(ours == (bytes(theirs) if isinstance(ours, bytes) else theirs))


def messages(kind: type[Message]) -> list[Message]:
    dice = random.Random(kind.ros_type)
    return [anything(kind, dice) for _ in range(TIMES)]


@cache
def told(ros_type: str, text: str) -> Any:
    """Return what rosbags reads of one definition: most stand in the texts of many types."""
    return get_types_from_msg(text, ros_type)


def test_rosbags_reads_and_writes_the_same() -> None:
    store = get_typestore(Stores.EMPTY)
    for kind in KINDS:
        name = kind.ros_type
        first, *others = ros2msg.text(kind).split(f"{ros2msg.BETWEEN}\nMSG: ")
        store.register(told(name, first))
        for short, _, text in (other.partition("\n") for other in others):
            store.register(told(short.replace("/", "/msg/"), text))
        for message in messages(kind):
            data = cdr.encode(message)
            theirs = store.deserialize_cdr(data, name)
            assert same(message, theirs), message
            assert bytes(store.serialize_cdr(theirs, name)) == data, message
            other_order = bytes(store.serialize_cdr(theirs, name, little_endian=False))
            assert cdr.decode(other_order, kind) == message


def test_mcap_ros2_reads_and_writes_the_same() -> None:
    for kind in KINDS:
        name, text = kind.ros_type, ros2msg.text(kind)
        read, write = generate_dynamic(name, text)[name], serialize_dynamic(name, text)[name]
        for message in messages(kind):
            data = cdr.encode(message)
            assert same(message, read(data)), message
            assert write(read(data)) == data, message


@pytest.mark.parametrize(
    "text",
    [
        "float64[] a\nfloat64 b\n",
        "float64[] a\nuint8 b\n",
        "uint8 z\nint64[] a\nint64[] b\nbool c\n",
        "string z\nfloat64[<=3] a\nuint16 b\nfloat64[] c\n",
        "X[] a\nuint8 b\n" + "=" * 80 + "\nMSG: x/X\nfloat64[] a\n",
        "uint8[] a\nfloat64 b\nuint8[3] c\nuint32 d\n",
        "X a\nuint8 b\nX[2] c\nfloat64 d\n" + "=" * 80 + "\nMSG: x/X\n",
    ],
)
def test_nor_do_they_differ_where_arrays_are_empty(text: str) -> None:
    kind, store = ros2msg.struct_of("x/msg/Top", text), get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, "x/msg/Top"))
    read = generate_dynamic("x/msg/Top", text)["x/msg/Top"]
    dice = random.Random(text)
    for _ in range(50):
        message = anything(kind, dice)
        data = cdr.encode(message)
        theirs = store.deserialize_cdr(data, "x/msg/Top")
        assert same(message, theirs)
        assert bytes(store.serialize_cdr(theirs, "x/msg/Top")) == data
        assert same(message, read(data))
