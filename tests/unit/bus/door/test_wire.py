"""Both ends of a wire, over a real socket pair."""

import socket
from collections.abc import Iterator

import msgspec
import pytest

from zteleop.bus.door.frames import LARGEST, Answer, Arrived, Ask, Hello, Put, Subscribe, Tokens
from zteleop.bus.door.wire import Wire

PUT = Put(1, b"payload", "text/plain", b"proof")


@pytest.fixture
def ends() -> Iterator[tuple[socket.socket, socket.socket]]:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        yield ours, theirs


Ends = tuple[socket.socket, socket.socket]


@pytest.mark.parametrize(
    "frame",
    [PUT, Put(2, b"", "", None), Subscribe(3, "robot/a/stop", 10)],
)
def test_what_is_asked_arrives_as_it_was_said(ends: Ends, frame: msgspec.Struct) -> None:
    guest, door = Wire(ends[0], Answer), Wire(ends[1], Ask)
    assert guest.send(frame)
    assert door.read() == [frame]


def test_what_is_answered_arrives_as_it_was_said(ends: Ends) -> None:
    answers = [Hello(), Arrived(1, "a/b", b"\xff", "e", None, False, 5.5), Tokens(2, ["a", "b"])]
    guest, door = Wire(ends[0], Answer), Wire(ends[1], Ask)
    for answer in answers:
        door.send(answer)
    assert guest.read() == answers


def test_a_frame_that_comes_in_pieces_is_whole_in_the_end(ends: Ends) -> None:
    guest, door = Wire(ends[0], Answer), Wire(ends[1], Ask)
    body = msgspec.msgpack.encode(PUT)
    data = len(body).to_bytes(4, "little") + body
    for byte in data[:-1]:
        ends[0].send(bytes([byte]))
        assert door.read() == []
    ends[0].send(data[-1:] + data)
    assert door.read() == [PUT, PUT]
    assert guest.read() == []


def test_what_the_other_end_does_not_take_is_dropped_whole_and_what_is_kept_is_not(ends: Ends) -> None:
    guest, door = Wire(ends[0], Answer), Wire(ends[1], Ask)
    large = Put(1, bytes(50_000), "e", None)
    taken = 0
    while guest.send(large):
        taken += 1
    assert not guest.send(PUT)
    assert guest.send(Subscribe(9, "a", 1), keep=True)
    heard = []
    while len(heard) <= taken:
        heard += door.read()
        guest.flush()
    assert heard == [*taken * [large], Subscribe(9, "a", 1)]
    assert guest.send(PUT), "there is room again"


def test_the_end_of_the_other_end_is_told(ends: Ends) -> None:
    door = Wire(ends[1], Ask)
    ends[0].close()
    with pytest.raises(EOFError):
        door.read()
    door.send(Hello())  # which nobody hears


@pytest.mark.parametrize(
    "data",
    [
        (LARGEST + 1).to_bytes(4, "little"),
        (3).to_bytes(4, "little") + b"abc",
        (2).to_bytes(4, "little") + b"\x91\x63",
    ],
)
def test_what_is_no_frame_ends_it(ends: Ends, data: bytes) -> None:
    ends[0].send(data)
    with pytest.raises(EOFError):
        Wire(ends[1], Ask).read()
