"""Frames over a socket between two processes, neither of which ever waits for the other."""

import socket
import threading
from contextlib import suppress
from typing import Any, Generic, TypeVar

import msgspec

from zteleop.bus.door.frames import LARGEST

T = TypeVar("T")
_HEAD = 4
"""bytes of a frame's length, little-endian, before it"""
_AT_ONCE = 2**18
"""bytes, which is more than a socket holds unless somebody has asked for it: one look takes all there is"""
_encode = msgspec.msgpack.Encoder().encode


class Wire(Generic[T]):
    """One end; what the other does not take in time is dropped, whole frames at a time."""

    def __init__(self, end: socket.socket, hears: Any) -> None:
        end.setblocking(False)
        self._socket = end
        self._decode = msgspec.msgpack.Decoder(hears).decode
        self._buffer = memoryview(bytearray(_AT_ONCE))  # kept: so much anew costs three calls of the system
        self._arrived = b""
        self._left = b""
        """What the other end must still take before anything else: the rest of a frame, and what is kept."""
        self._sending = threading.Lock()  # logs, and zenoh, speak from threads of their own

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()

    def send(self, frame: msgspec.Struct, *, keep: bool = False) -> bool:
        """Say a frame; False when the other end does not take it, unless it is kept until it does."""
        body = _encode(frame)
        data = len(body).to_bytes(_HEAD, "little") + body
        with self._sending:
            if self._left and not self._flush():
                self._left += data if keep else b""
                return keep
            sent = self._send(data)
            if sent or keep:
                self._left = data[sent:]
            return bool(sent) or keep

    @property
    def lags(self) -> bool:
        """The other end has not taken all of it yet."""
        return bool(self._left)

    def flush(self) -> None:
        """Say what is left."""
        if self._left:
            with self._sending:
                self._flush()

    def read(self) -> list[T]:
        """Return what has arrived; raises EOFError when the other end is gone, or speaks in no frames."""
        try:
            length = self._socket.recv_into(self._buffer)
        except BlockingIOError:
            return []
        except OSError:
            raise EOFError from None
        if not length:
            raise EOFError
        data = bytes(self._buffer[:length])
        return self._take(self._arrived + data if self._arrived else data)

    def _take(self, data: bytes) -> list[T]:
        frames, at = [], 0
        while len(data) - at >= _HEAD:
            length = int.from_bytes(data[at : at + _HEAD], "little")
            if length > LARGEST:
                raise EOFError
            end = at + _HEAD + length
            if end > len(data):
                break
            try:
                frames.append(self._decode(data[at + _HEAD : end]))
            except (msgspec.MsgspecError, UnicodeDecodeError):
                raise EOFError from None
            at = end
        self._arrived = data[at:]
        return frames

    def _flush(self) -> bool:
        self._left = self._left[self._send(self._left) :]
        return not self._left

    def _send(self, data: bytes) -> int:
        with suppress(OSError):  # full: the other end is frozen; broken: it is gone, which `read` tells
            return self._socket.send(data)
        return 0
