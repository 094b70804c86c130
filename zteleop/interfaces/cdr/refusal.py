"""What is said of bytes that are not the message they should be."""

import struct
from typing import NoReturn

from zteleop.errors import MessageError

ORDERS = {"<": b"\0\1", ">": b"\0\0"}
"""how data begins, by the order of its bytes"""
WRONG = (struct.error, IndexError, UnicodeError, OverflowError, MemoryError)
"""what comes of reading bytes that are none"""


def header(data: bytes) -> str:
    return f"expected CDR, which begins with 00 00 or 00 01, found {data[:2].hex(' ')!r}"


def broken(ros_type: str, data: bytes, error: Exception) -> NoReturn:
    if data[:2] not in ORDERS.values():
        raise MessageError(header(data)) from None
    why = "they end within it" if isinstance(error, struct.error | IndexError) else str(error)
    raise MessageError(f"not a {ros_type} in {len(data)} bytes: {why}") from None


def long(ros_type: str, end: int, length: int) -> NoReturn:
    raise MessageError(f"not a {ros_type}: expected {end} bytes, found {length}")


def short(end: int, length: int) -> NoReturn:
    raise MessageError(f"what is said to be {end} bytes long has {length}")


def too_many(most: int, found: int) -> NoReturn:
    raise MessageError(f"expected at most {most} characters or items, found {found}")


def endless() -> NoReturn:
    raise MessageError("a text does not end with a zero byte")
