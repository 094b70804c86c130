"""Any bytes: a message or a MessageError. Any attachment: no proof, or one that moves nothing."""

import json
from collections.abc import Callable
from contextlib import suppress
from math import isfinite
from typing import Any

import msgspec
from hypothesis import given, settings
from hypothesis import strategies as st

from zteleop.bus import codec
from zteleop.control.deadlines import Deadlines
from zteleop.control.gate import Gate
from zteleop.control.proof import Proof
from zteleop.errors import MessageError
from zteleop.interfaces.values import fill
from zteleop.messages import MESSAGES, Message

ZEROS = [codec.encode(kind.zero()) for kind in MESSAGES.values()]
NAMES = [codec.encoding_of(kind) for kind in MESSAGES.values()]
ALL = codec.decoders(MESSAGES.values())
ENCODINGS = st.one_of(
    st.sampled_from(NAMES), st.text(max_size=20), st.sampled_from([*MESSAGES, "", "zenoh/bytes"])
)
PLAIN = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.sampled_from([2**15, -(2**31) - 1, 2**63, 2**64, 10**30]),
        st.floats(),
        st.text(max_size=5),
    ),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=4),
    max_leaves=8,
)


def mended(zero: Any, draw: Callable[[st.SearchStrategy[Any]], Any]) -> Any:
    """Put anything into one place of a message's values, perhaps deep within."""
    if isinstance(zero, dict) and zero and draw(st.integers(0, 5)):
        name = draw(st.sampled_from([*zero]))
        return zero | {name: mended(zero[name], draw)}
    return draw(PLAIN)


@st.composite
def nearly(draw: Callable[[st.SearchStrategy[Any]], Any]) -> tuple[type[Message], Any]:
    """Draw a type, and the values of a message of it with something wrong, or right, in one place."""
    kind = draw(st.sampled_from([*MESSAGES.values()]))
    return kind, mended(msgspec.to_builtins(kind.zero()), draw)


@st.composite
def torn(draw: Callable[[st.SearchStrategy[Any]], Any]) -> bytes:
    """Draw a message's bytes with a piece replaced."""
    payload = draw(st.sampled_from(ZEROS))
    cut, end = sorted(draw(st.tuples(*[st.integers(0, len(payload))] * 2)))
    return payload[:cut] + draw(st.binary(max_size=4)) + payload[end:]


def check(payload: bytes, encoding: str) -> None:
    message = None
    with suppress(MessageError):
        message = codec.decode(payload, encoding, ALL)
        assert isinstance(message, Message)
    assert message is None or codec.decode(codec.encode(message), encoding, ALL) == message
    with suppress(MessageError):
        codec.decode_any(payload, encoding)


@settings(max_examples=500, deadline=None)
@given(st.one_of(st.binary(max_size=60), torn(), st.sampled_from(ZEROS)), ENCODINGS)
def test_any_bytes_are_a_message_or_a_message_error(payload: bytes, encoding: str) -> None:
    check(payload, encoding)


@settings(max_examples=500, deadline=None)
@given(nearly())
def test_anything_in_any_field_is_a_message_or_a_message_error(found: tuple[type[Message], Any]) -> None:
    kind, values = found
    check(json.dumps(values).encode(), codec.encoding_of(kind))


@settings(max_examples=500, deadline=None)
@given(st.one_of(nearly(), st.tuples(st.sampled_from([*MESSAGES.values()]), PLAIN)))
def test_whatever_somebody_typed_is_a_message_or_a_message_error(found: tuple[type[Message], Any]) -> None:
    kind, values = found
    try:
        message = fill(kind, values)
        payload = codec.encode(message)
    except MessageError:
        return
    assert type(message) is kind
    assert codec.decode(payload, codec.encoding_of(kind), ALL) == message


@settings(max_examples=500)
@given(st.binary(max_size=100) | st.binary(min_size=48, max_size=48))
def test_any_attachment_is_a_proof_or_none(attachment: bytes) -> None:
    proof = codec.unpack_proof(attachment)
    assert (proof is None) == (len(attachment) != 48)
    assert proof is None or codec.pack_proof(proof) == attachment or not all(map(isfinite, proof[3:]))


SENDERS, UINT64 = st.integers(0, 3), st.integers(0, 2**64 - 1)
WAITS = st.floats(0, 1)
TIMES = st.one_of(st.floats(), st.floats(99, 103))
PROOFS = st.one_of(
    st.binary(min_size=48, max_size=48).map(codec.unpack_proof),
    st.builds(Proof, UINT64, UINT64, UINT64, TIMES, TIMES, TIMES),
)


@settings(max_examples=300)
@given(st.lists(st.tuples(PROOFS, st.booleans(), WAITS), max_size=10))
def test_no_proof_that_was_guessed_moves_the_robot(guesses: list[tuple[Proof, bool, float]]) -> None:
    epoch, now = 7 << 50, 100.0
    gate = Gate(Deadlines(), epoch, now)
    for proof, moving, wait in guesses:
        now += wait
        refusal = gate.judge(proof, moving, now)
        assert refusal or proof.epoch == epoch


@settings(max_examples=500)
@given(
    st.lists(
        st.tuples(st.integers(0, 3), UINT64, TIMES, TIMES, TIMES, st.booleans(), st.floats(0, 1)), max_size=12
    )
)
def test_whoever_knows_the_epoch_still_needs_times_that_are_true(guesses: list[tuple[Any, ...]]) -> None:
    now = 100.0
    gate = Gate(Deadlines(), 1, now)
    for sender, seq, beat, acted, began, moving, wait in guesses:
        now += wait
        refusal = gate.judge(Proof(sender, seq, 1, beat, acted, began), moving, now)
        if refusal is None:
            assert 0 <= now - beat <= 0.3
            assert not moving or (0 <= now - acted <= 5.0 and 100.0 < began <= acted)
