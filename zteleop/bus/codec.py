"""Messages to bytes and back: JSON, the same on the wire, in a shell and in a browser.

The sample's encoding names the type, such as `application/json;geometry_msgs/msg/Twist`.
"""

import struct
from collections.abc import Callable, Iterable
from functools import cache
from math import isfinite
from typing import Any

import msgspec

from zteleop.control.proof import Proof
from zteleop.errors import MessageError
from zteleop.machine.signals import sheltered
from zteleop.messages import MESSAGES, Message, Twist
from zteleop.messages.message import field_types

MAX_BYTES = 1 << 20
_JSON = "application/json;"
_PROOF = struct.Struct("<QQQddd")
_encode_json = msgspec.json.Encoder().encode

Decoder = Callable[[bytes], Message]


def encoding_of(kind: type[Message]) -> str:
    """Return the encoding that tells a reader the type."""
    return _JSON + kind.ros_type


def encode(message: Message) -> bytes:
    """Return a message's bytes; raises MessageError for what no reader would take."""
    kind = type(message)
    try:
        payload = _encode_json(message)
        _reader(kind)(payload)
    except msgspec.ValidationError as error:
        endless = _not_finite(msgspec.to_builtins(message), kind.__name__)  # which JSON writes as null
        words = f"cannot send {kind.__name__}: {_not_a_message(message) or error}"
        raise MessageError(endless or words) from None
    except (TypeError, ValueError, OverflowError) as error:
        raise MessageError(f"cannot send {kind.__name__}: {error}") from None
    return payload


@cache
def _reader(kind: type[Message]) -> Decoder:
    with sheltered():
        return msgspec.json.Decoder(kind).decode


def decoders(kinds: Iterable[type[Message]]) -> dict[str, Decoder]:
    """Return how to read each encoding a topic accepts."""
    return {encoding_of(kind): _reader(kind) for kind in kinds}


def decode(payload: bytes, encoding: str, accepted: dict[str, Decoder]) -> Message:
    """Return the message that bytes are; raises MessageError when they are none of those accepted."""
    decoder = accepted.get(encoding)
    if decoder is None:
        expected = " or ".join(name.removeprefix(_JSON) for name in accepted)
        raise MessageError(f"expected {expected}, found {encoding.removeprefix(_JSON)!r}")
    if len(payload) > MAX_BYTES:
        raise MessageError(f"expected at most {MAX_BYTES} bytes, found {len(payload)}")
    try:
        return decoder(payload)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise MessageError(f"not a {encoding.removeprefix(_JSON)}: {error}") from None


def decode_any(payload: bytes, encoding: str) -> Any:
    """Return bytes of any type as plain values; raises MessageError when they cannot be read."""
    kind = MESSAGES.get(encoding.removeprefix(_JSON))
    if kind and encoding.startswith(_JSON):
        return msgspec.to_builtins(decode(payload, encoding, decoders([kind])))
    if len(payload) > MAX_BYTES:
        raise MessageError(f"{len(payload)} bytes of {encoding!r}")
    try:
        return msgspec.json.decode(payload)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise MessageError(f"{len(payload)} bytes of {encoding!r}, not JSON: {error}") from None


def pack_proof(proof: Proof) -> bytes:
    """Return the 48 bytes a proof travels as: three uint64, three float64, little-endian."""
    return _PROOF.pack(*proof)


def unpack_proof(attachment: bytes) -> Proof | None:
    """Return the proof in an attachment; None when there is none."""
    return Proof._make(_PROOF.unpack(attachment)) if len(attachment) == _PROOF.size else None


def _not_a_message(message: Message) -> str:
    """Return which field holds something else than its message, if one does, and what makes one."""
    for name, kind in field_types(type(message)).items():
        value = getattr(message, name)
        if isinstance(kind, type) and issubclass(kind, Message) and not isinstance(value, kind):
            planar = "; Twist.planar(0.3, 0.6) is made from m/s and rad/s" * isinstance(message, Twist)
            return f"expected a {kind.__name__} as {name}, found {value!r:.40}{planar}"
    return ""


def _not_finite(value: Any, path: str) -> str:
    """Return where there is a number that is not finite, in a sentence; nothing where there is none."""
    if isinstance(value, float) and not isfinite(value):
        return f"expected a finite number, found {value} at {path}"
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return next(filter(None, (_not_finite(item, f"{path}.{key}") for key, item in items)), "")
