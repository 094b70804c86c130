import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.lane.wire import LONGEST, Answered, Asked, pack, unpack_answered, unpack_asked
from zteleop.messages import Stop

LONG = "\N{SNOWMAN}" * 200


def test_a_stop_is_a_line_that_anything_can_say() -> None:
    said = b'{"zteleop": "stop", "robot": "archangel", "id": 7, "by": "a button"}'
    asked = unpack_asked(said)
    assert asked == Asked("archangel", 7, "a button")
    assert asked.stop == Stop(True, 7, "a button", "")


def test_both_come_back_as_they_were() -> None:
    asked = Asked("archangel", 2**53 - 1, "ann@desk", "a cat", ("192.168.1.7", 4711))
    answered = Answered("archangel", 1, True, "cut", "the disk is full")
    assert unpack_asked(pack(asked)) == asked
    assert unpack_answered(pack(answered)) == answered


def test_the_longest_words_fit_a_datagram() -> None:
    most = Asked("r" * 64, 2**53 - 1, LONG[:200], "", ("2001:db8::1", 65535))
    assert len(pack(most)) <= LONGEST


@pytest.mark.parametrize(
    "said",
    [
        b"",
        b"{",
        b"[]",
        b"\xff\xfe",
        b"[" * 5000,
        b'{"zteleop": "release", "robot": "a", "id": 7, "by": "x"}',
        b'{"zteleop": "answer", "robot": "a", "id": 7, "held": true}',
        b'{"zteleop": "stop", "robot": "a", "id": 0, "by": "x"}',
        b'{"zteleop": "stop", "robot": "a", "id": 9007199254740992, "by": "x"}',
        b'{"zteleop": "stop", "robot": "a", "by": "x"}',
        b'{"zteleop": "stop", "robot": 7, "id": 7, "by": "x"}',
        b'{"zteleop": "stop", "robot": "a", "id": 7, "by": "x", "answer_to": ["h", 0]}',
        msgspec.json.encode({"zteleop": "stop", "robot": "a", "id": 7, "by": "x" * 201}),
    ],
)
def test_what_is_no_stop_is_none(said: bytes) -> None:
    assert unpack_asked(said) is None


@given(st.binary(max_size=200))
def test_any_bytes_are_a_stop_or_none(said: bytes) -> None:
    assert unpack_asked(said) is None or unpack_asked(said).stop.engaged
    unpack_answered(said)
