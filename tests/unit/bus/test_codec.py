import signal
from contextlib import suppress
from math import inf, nan
from types import SimpleNamespace
from typing import Annotated, Any, Literal, get_args, get_origin

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Meta

from zteleop.bus import codec
from zteleop.control.proof import NEVER, Proof
from zteleop.errors import MessageError
from zteleop.machine import signals
from zteleop.messages import (
    MESSAGES,
    Beat,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Odometry,
    Pwm,
    String,
    Time,
    Twist,
    TwistStamped,
    Vector3,
)
from zteleop.messages.message import field_types

KINDS = sorted(MESSAGES.values(), key=lambda kind: kind.ros_type)
PWM = "application/json;zteleop_msgs/msg/Pwm"
UINT64 = st.integers(0, 2**64 - 1)


def values_of(annotation: Any) -> st.SearchStrategy[Any]:
    """Return any value that a field takes."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated and get_origin(arguments[0]) is list:
        (item,), meta = get_args(arguments[0]), arguments[1]
        return st.lists(values_of(item), min_size=meta.min_length or 0, max_size=meta.max_length)
    if origin is Annotated:
        metas = [meta for meta in arguments[1:] if isinstance(meta, Meta)]
        if arguments[0] is str:
            return st.text(max_size=min(meta.max_length for meta in metas))
        most = metas[0].lt - 1 if metas[0].lt is not None else metas[0].le
        return st.integers(metas[0].ge, 2**63 if most is None else most)
    if origin is list:
        return st.lists(values_of(arguments[0]), max_size=3)
    if origin is Literal:
        return st.sampled_from(arguments)
    if issubclass(annotation, Message):
        fields = field_types(annotation).items()
        return st.builds(annotation, **{name: values_of(kind) for name, kind in fields})
    plain = {
        float: st.floats(allow_nan=False, allow_infinity=False),
        int: st.integers(0, 2**53 - 1),
        bool: st.booleans(),
        str: st.text(max_size=8),
        bytes: st.binary(max_size=8),
    }
    return plain[annotation]


ANY_MESSAGE = st.sampled_from([k for k in KINDS if k is not Odometry]).flatmap(values_of)


def read(message: Message, payload: bytes) -> Message:
    return codec.decode(payload, codec.encoding_of(type(message)), codec.decoders([type(message)]))


def test_zeros_of_every_type_survive_the_way() -> None:
    for kind in KINDS:
        assert read(kind.zero(), codec.encode(kind.zero())) == kind.zero()


@given(ANY_MESSAGE)
def test_every_message_survives_the_way(message: Message) -> None:
    payload = codec.encode(message)
    assert read(message, payload) == message
    assert codec.decode_any(payload, codec.encoding_of(type(message))) == msgspec.to_builtins(message)


def test_the_encoding_names_format_and_type() -> None:
    assert codec.encoding_of(Twist) == "application/json;geometry_msgs/msg/Twist"


@pytest.mark.parametrize("number", [nan, inf, -inf])
def test_a_number_that_is_not_finite_is_refused_with_its_path(number: float) -> None:
    message = TwistStamped(Header.zero(), Twist(Vector3(0.0, 0.0, 0.0), Vector3(0.0, number, 0.0)))
    words = f"expected a finite number, found {number} at TwistStamped.twist.angular.y"
    with pytest.raises(MessageError) as error:
        codec.encode(message)
    assert str(error.value) == words
    assert error.value.__suppress_context__, "one sentence, and not what JSON made of it"


def test_a_number_that_is_not_finite_is_found_in_a_list() -> None:
    message = Odometry.zero()
    message.pose.covariance[35] = nan
    with pytest.raises(MessageError, match=r"found nan at Odometry\.pose\.covariance\.35"):
        codec.encode(message)


@pytest.mark.parametrize("text", ["null", '{"x": null}', "annulled, nullified"])
def test_the_word_null_is_only_a_word(text: str) -> None:
    assert read(String(text), codec.encode(String(text))) == String(text)


@pytest.mark.parametrize(
    "message",
    [String("\ud800"), String(object()), Twist(1, object())],  # type: ignore[arg-type]
    ids=["a lone surrogate", "an object for text", "an object for a vector"],
)
def test_what_json_cannot_say_is_refused(message: Message) -> None:
    with pytest.raises(MessageError, match=f"cannot send {type(message).__name__}: "):
        codec.encode(message)


def test_numbers_for_vectors_are_told_with_what_makes_a_twist() -> None:
    with pytest.raises(MessageError) as error:
        codec.encode(Twist(0.3, 0.6))  # type: ignore[arg-type]
    words = "expected a Vector3 as linear, found 0.3; Twist.planar(0.3, 0.6) is made from m/s and rad/s"
    assert str(error.value) == f"cannot send Twist: {words}"
    with pytest.raises(MessageError, match=r"expected a Header as header, found None$"):
        codec.encode(TwistStamped(None, Twist.planar()))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"", "truncated"),
        (b'{"steering_ticks":1,"throttle_ticks":', "truncated"),
        (b'{"steering_ticks":1}', "missing required field `throttle_ticks`"),
        (b'{"steering_ticks":1,"throttle_ticks":null}', "`int`, got `null` - at `$.throttle_ticks`"),
        (b'{"steering_ticks":1,"throttle_ticks":32768}', "`int` <= 32767 - at `$.throttle_ticks`"),
        (b'{"steering_ticks":-32769,"throttle_ticks":1}', "`int` >= -32768 - at `$.steering_ticks`"),
        (b'{"steering_ticks":1,"throttle_ticks":"1"}', "`int`, got `str`"),
        (b'{"steering_ticks":1,"throttle_ticks":1.5}', "`int`, got `float`"),
        (b"[1,2]", "`object`, got `array`"),
        (b"null", "`object`, got `null`"),
        (b'{"steering_ticks":1,"throttle_ticks":1} ,', "malformed"),
        (b"\xff\xfe", "malformed"),
        (b'{"other":' + b"[" * 100_000, "recursion"),
        (b'{"other":' + b"[" * 100_000 + b"]" * 100_000 + b"}", "recursion"),
    ],
    ids=lambda value: repr(value)[:40],
)
def test_what_is_no_message_is_refused_in_words(payload: bytes, words: str) -> None:
    with pytest.raises(MessageError) as error:
        codec.decode(payload, PWM, codec.decoders([Pwm]))
    assert str(error.value).startswith("not a zteleop_msgs/msg/Pwm: ")
    assert words in str(error.value)


def test_nan_on_the_wire_is_no_number() -> None:
    for word in (b"NaN", b"Infinity", b"1e999"):
        with pytest.raises(MessageError):
            codec.decode_any(b'{"epoch":1,"time":' + word + b"}", codec.encoding_of(Beat))


def test_another_type_is_refused_by_both_names() -> None:
    accepted = codec.decoders([TwistStamped, Twist])
    with pytest.raises(MessageError) as error:
        codec.decode(b"{}", PWM, accepted)
    expected = "geometry_msgs/msg/TwistStamped or geometry_msgs/msg/Twist"
    assert str(error.value) == f"expected {expected}, found 'zteleop_msgs/msg/Pwm'"


def test_the_encoding_chooses_among_the_types_a_topic_takes() -> None:
    accepted = codec.decoders([TwistStamped, Twist])
    for message in (Twist.planar(1.0), TwistStamped(Header(Time(1, 2), "base_link"), Twist.planar(2.0))):
        payload = codec.encode(message)
        assert codec.decode(payload, codec.encoding_of(type(message)), accepted) == message


def test_fields_nobody_knows_are_ignored() -> None:
    payload = b'{"steering_ticks":1,"gear":3,"throttle_ticks":2}'
    assert codec.decode(payload, PWM, codec.decoders([Pwm])) == Pwm(1, 2)


def test_what_is_too_large_is_refused_unread() -> None:
    padding = b" " * codec.MAX_BYTES
    message = codec.encode(Pwm(1, 2))
    exact = message + padding[len(message) :]
    assert codec.decode(exact, PWM, codec.decoders([Pwm])) == Pwm(1, 2)
    for payload, encoding in ((exact + b" ", PWM), (exact + b" ", "text/plain")):
        with pytest.raises(MessageError, match=str(codec.MAX_BYTES + 1)):
            codec.decode_any(payload, encoding)


def test_a_list_holds_only_its_items() -> None:
    message = Int16MultiArray(MultiArrayLayout.zero(), [40000])
    with pytest.raises(MessageError, match=r"<= 32767 - at `\$\.data\[0\]`"):
        read(message, codec.encode(message))


def test_a_foreign_type_is_read_as_plain_json() -> None:
    assert codec.decode_any(b'{"a":[1,null]}', "application/json;their_msgs/msg/Thing") == {"a": [1, None]}
    assert codec.decode_any(b"3", "") == 3


def test_a_known_type_is_read_as_its_fields() -> None:
    with pytest.raises(MessageError, match="missing required field"):
        codec.decode_any(b"{}", PWM)


def test_bytes_nobody_can_read_are_counted_and_named() -> None:
    for payload in (b"\x00\x01\x02", b"[[", b"[" * 100_000, b'"\xff"'):
        with pytest.raises(MessageError, match=f"^{len(payload)} bytes of 'zenoh/bytes', not JSON: "):
            codec.decode_any(payload, "zenoh/bytes")


def test_a_types_name_alone_is_no_encoding_of_it() -> None:
    assert codec.decode_any(b'{"data":"hello"}', "std_msgs/msg/String") == {"data": "hello"}


@given(st.builds(Proof, UINT64, UINT64, UINT64, *[st.floats(allow_nan=False)] * 3))
def test_a_proof_survives_the_way(proof: Proof) -> None:
    packed = codec.pack_proof(proof)
    assert len(packed) == 48
    assert codec.unpack_proof(packed) == proof


def test_a_proof_is_laid_out_as_other_languages_write_it() -> None:
    packed = codec.pack_proof(Proof(1, 2, 3, 0.0, 1.0, NEVER))
    assert packed == bytes.fromhex(
        "0100000000000000 0200000000000000 03000000000000000000000000000000 000000000000f03f 000000000000f0ff"
    )


@pytest.mark.parametrize("length", [0, 1, 47, 49, 96])
def test_an_attachment_of_another_length_is_no_proof(length: int) -> None:
    assert codec.unpack_proof(bytes(length)) is None


@pytest.mark.parametrize("epoch", [-1, 2**64, 10**30])
def test_an_epoch_that_no_proof_can_echo_is_no_beat(epoch: int) -> None:
    """Anybody may say a beat; whoever echoes it in a proof must not fall over it."""
    with pytest.raises(MessageError):
        codec.decode_any(b'{"epoch":%d,"time":1.0}' % epoch, codec.encoding_of(Beat))


def test_a_signal_while_a_reader_is_made_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Msgspec drops what is raised in the Python code that it calls then."""

    def make(kind: type) -> object:
        with suppress(BaseException):
            signal.raise_signal(signal.SIGINT)
        return SimpleNamespace(decode=kind)

    monkeypatch.setattr(msgspec.json, "Decoder", make)
    monkeypatch.setattr(signals, "_raised", float("-inf"))
    undo = signals.unwind()
    try:
        with pytest.raises(KeyboardInterrupt):
            codec._reader.__wrapped__(String)
    finally:
        undo()
