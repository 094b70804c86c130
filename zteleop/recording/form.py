"""How messages are kept, as `interfaces.form` says for a type, and how they are read again, of any file."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import msgspec

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, foreign, library, ros2msg
from zteleop.interfaces.form import CDR, JSON, JSON_SCHEMA, Form, Write, form_of, writer_of
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Message
from zteleop.messages.message import plain

__all__ = [
    "CDR",
    "JSON",
    "JSON_SCHEMA",
    "MESSAGEPACK",
    "Form",
    "Read",
    "Write",
    "form_of",
    "reader_of",
    "type_of",
    "unknown",
    "values_of",
    "writer_of",
]

MESSAGEPACK = "msgpack"
WITHOUT = ("", "ros2idl", "omgidl")
"""ways to tell a schema, or none, of which the name of the type is all that is used"""
MOST = 1024
"""types that are remembered"""

Read = Callable[[bytes], Message]


def unknown(encoding: str) -> Form:
    """Return how messages are kept of which only the encoding of the bus is known: as they came."""
    for name, kept in (("application/msgpack;", MESSAGEPACK), ("application/json;", JSON)):
        if encoding.startswith(name):
            return Form(encoding.removeprefix(name), kept)
    return Form(encoding, JSON)


@lru_cache(MOST)
def type_of(form: Form) -> type[Message]:
    """Return the type that a file keeps in a form, from the schema in the file itself.

    Where it has none that is read here, but ROS's own encoding, the type of that name is it. Raises
    MessageError where nothing tells what a message is made of.
    """
    if form.schema_encoding == ros2msg.ENCODING:
        return ros2msg.struct_of(form.type, form.schema.decode(errors="replace"))
    if form.schema_encoding == JSON_SCHEMA:
        return foreign.struct_of(_json(form.schema), form.type)
    if form.encoding == CDR and form.schema_encoding in WITHOUT and library.has(form.type):
        return struct_of(form.type)
    raise MessageError(
        f"{form.type:.100} has a schema in {form.schema_encoding or 'no known way'!r:.40}, "
        f"which is not read here; expected {ros2msg.ENCODING} or {JSON_SCHEMA}"
    )


def reader_of(form: Form) -> Read:
    """Return what reads the messages that a file keeps in a form; what it returns raises MessageError.

    Raises MessageError itself where nobody here can read them: their bytes are all that is known.
    """
    kind = type_of(form)
    if form.encoding == CDR:
        return cdr.decoder(kind)
    if form.encoding == JSON:
        return _json_reader(kind)
    raise MessageError(
        f"{form.type:.100} is kept as {form.encoding!r:.40}, which is not read here; expected {CDR}"
    )


def values_of(form: Form) -> Callable[[bytes], Any]:
    """Return what reads the messages in a form as plain values, also those without a schema.

    Raises MessageError where nobody here can.
    """
    if form.encoding == JSON:
        return _json_values(form)
    if form.schema_encoding or form.encoding == CDR:
        read = reader_of(form)
        return lambda data: plain(read(data))
    if form.encoding == MESSAGEPACK:
        return _messagepack
    raise MessageError(f"{form.type:.100} is kept as {form.encoding!r:.40}, which is not read here")


def _json_values(form: Form) -> Callable[[bytes], Any]:
    """Return what reads JSON, which can be read also where its schema cannot."""
    try:
        read = reader_of(form)
    except MessageError:
        return _json
    return lambda data: plain(read(data))


def _json_reader(kind: type[Message]) -> Read:
    decode = msgspec.json.Decoder(kind).decode

    def read(data: bytes) -> Message:
        try:
            return decode(data)
        except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
            raise MessageError(f"not a {kind.ros_type}: {error}") from None

    return read


def _json(data: bytes) -> Any:
    try:
        return msgspec.json.decode(data)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise MessageError(f"not JSON: {error}") from None


def _messagepack(data: bytes) -> Any:
    try:
        return msgspec.msgpack.decode(data)
    except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        raise MessageError(f"not MessagePack: {error}") from None
