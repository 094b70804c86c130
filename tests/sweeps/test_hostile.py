"""Whatever a stranger sends: refused in words, and never more memory than its bytes are worth."""

import random
import struct
import tracemalloc
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import settings
from unit.interfaces.cdr.values import anything, halves, kinds

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, ros2msg
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Bool, Message

HEADER = b"\0\1\0\0"
LIES = [0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0x00FFFFFF]
"""lengths: 4 GiB, -2**31 and -1 where one reads them with a sign, and 16 MiB"""
ALL = sorted(
    {*kinds(), *halves()} - {struct_of("example_interfaces/msg/WString")}, key=lambda kind: kind.ros_type
)
PLACES = settings.default.max_examples // 6
"""of each message at which a length lies, in either order of bytes"""
WORTH = 100
"""bytes of Python's for one that came: the smallest message in a list is one"""


def takes(data: bytes, kind: type[Message], at_most: float) -> bool:
    """Say whether reading some bytes takes at most so much memory: once of three, as others' adds up."""
    read = cdr.decoder(kind)
    return any(_traced_peak(read, data) < at_most for _ in range(3))


def _traced_peak(read: Callable[[bytes], object], data: bytes) -> int:
    """Count what all threads of this process took meanwhile, those of a runner of tests as well."""
    tracemalloc.reset_peak()
    before = tracemalloc.get_traced_memory()[0]
    with suppress(MessageError):
        read(data)
    return tracemalloc.get_traced_memory()[1] - before


@pytest.fixture
def _traced() -> Any:
    tracemalloc.start()
    yield
    tracemalloc.stop()


@pytest.fixture(scope="module")
def encoded() -> list[tuple[type[Message], bytes]]:
    """One message of each type: what it takes to make them is not to be counted."""
    dice = random.Random(3)
    return [(kind, cdr.encode(anything(kind, dice))) for kind in ALL if cdr.decoder(kind)]


@pytest.mark.usefixtures("_traced")
def test_a_length_that_lies_takes_no_memory_wherever_it_stands(
    encoded: list[tuple[type[Message], bytes]],
) -> None:
    dice = random.Random(4)
    for kind, data in encoded:
        for order, header in (("<", HEADER), (">", bytes(4))):
            places = range(4, len(data), 4)
            for at in dice.sample(places, min(PLACES, len(places))):
                lying = header + data[4:at] + struct.pack(f"{order}I", dice.choice(LIES)) + data[at + 4 :]
                assert takes(lying, kind, 20_000 + WORTH * len(lying)), (kind.ros_type, at)


@pytest.mark.usefixtures("_traced")
@pytest.mark.parametrize("item", ["Empty", "bool", "string", "Empty[<=3]", "float64", "uint8"])
def test_what_is_long_takes_as_much_as_its_bytes_are_worth(item: str) -> None:
    field = "Wrap[] x" if item.endswith("]") else f"{item}[] x"
    rest = f"\n{'=' * 80}\nMSG: a/Wrap\nEmpty[<=3] y\n{'=' * 80}\nMSG: a/Empty\n"
    kind = ros2msg.struct_of("a/msg/B", field + rest)
    for count in (2**10, 2**15, 2**20, 2**32 - 1):
        data = HEADER + struct.pack("<I", count) + bytes(2**17)
        assert takes(data, kind, WORTH * len(data))


@pytest.mark.usefixtures("_traced")
def test_a_fixed_array_that_the_bytes_cannot_fill_takes_no_memory() -> None:
    for item in ("float64", "uint8", "string", "Part"):
        kind = ros2msg.struct_of("a/msg/B", f"{item}[400000] x\n{'=' * 80}\nMSG: a/Part\nuint8 x\n")
        assert takes(HEADER + bytes(1000), kind, 120_000)


def test_every_message_that_is_cut_anywhere_is_refused() -> None:
    dice = random.Random(4)
    for kind in ALL:
        data = cdr.encode(anything(kind, dice))
        for length in {*range(8), *(dice.randrange(len(data)) for _ in range(20)), len(data) - 1}:
            with pytest.raises(MessageError):
                cdr.decode(data[: min(length, len(data) - 1)], kind)


def test_of_every_message_what_follows_is_padding_or_refused() -> None:
    dice = random.Random(5)
    for kind in ALL:
        message = anything(kind, dice)
        data = cdr.encode(message)
        assert cdr.decode(data + dice.randbytes(3), kind) == message
        with pytest.raises(MessageError, match=f"expected {len(data)} bytes, found {len(data) + 4}"):
            cdr.decode(data + bytes(4), kind)


def test_every_other_representation_is_named() -> None:
    for number in [*range(2, 600), *range(600, 2**16, 101)]:
        with pytest.raises(MessageError, match="expected CDR, which begins with 00 00 or 00 01, found '"):
            cdr.decode(number.to_bytes(2, "big") + b"\0\0\1", Bool)


@pytest.mark.parametrize("data", [b"", b"\0", b"\0\7\0\0", b"\0\x0b\0\0\0", b"\0\3\0\0" + bytes(3)])
def test_it_is_named_even_where_the_bytes_are_too_few(data: bytes) -> None:
    for kind in ALL:
        with pytest.raises(MessageError, match="expected CDR, which begins with"):
            cdr.decode(data, kind)


@pytest.mark.parametrize("array", ["", "[2]", "[]"])
def test_a_message_as_deep_as_one_may_be_is_read(array: str) -> None:
    kinds_within = [f"P{n + 1}{array if n > 43 else ''}" for n in range(48)]
    levels = "\n".join(f"{'=' * 80}\nMSG: a/P{n}\n{inner} x" for n, inner in enumerate(kinds_within))
    kind = ros2msg.struct_of("a/msg/B", f"P0 x\n{levels}\n{'=' * 80}\nMSG: a/P48\nuint8 x\n")
    assert cdr.decode(cdr.encode(kind.zero()), kind) == kind.zero()
    with suppress(MessageError):
        cdr.decode(HEADER + b"\1\0\0\0" * 60, kind)
