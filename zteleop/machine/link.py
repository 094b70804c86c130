"""The socket pair between watchdog and actuator: reports up, beats down; its end is the other's death."""

import socket
from contextlib import suppress
from struct import Struct
from typing import NamedTuple

import msgspec

from zteleop.control.standing import Standing
from zteleop.errors import DeviceError
from zteleop.messages import Stop

_REPORT = Struct("<d?Qdddhqdd")
_STOP_HEAD = Struct("<cH")
_BYTES = 4096

HEARS = b"h"
"""The watchdog lives, and hears the bus."""
HEARS_NOT = b"d"
"""The watchdog lives, and does not hear the actuator's beats on the bus."""
CUT = {HEARS: b"H", HEARS_NOT: b"D"}
"""The same, and no pulse leaves the chip: its outputs are cut."""
STOP = b"s"
"""A stop follows, two bytes of its length before it: obey it now."""
UNWATCHED = 75
"""The exit code of an actuator that ended at rest because nobody watched it: EX_TEMPFAIL of sysexits.h."""


def gone() -> DeviceError:
    """Return the error of an actuator whose watchdog has ended."""
    return DeviceError(
        "the watchdog is gone; the actuator does not run without one: start zteleop actuator again"
    )


class Report(NamedTuple):
    """One step of the actuator."""

    stepped: float
    standing: Standing
    stopped: bool = False
    """a stop is in force, and it rests for it"""


class End:
    """One end; never blocks, because the other side may be frozen."""

    def __init__(self, file: socket.socket) -> None:
        self._socket = file
        file.setblocking(False)

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()

    def _send(self, data: bytes) -> None:
        with suppress(OSError):  # full: the other side is frozen; broken: it is gone, which `read` tells
            self._socket.send(data)

    def _read(self) -> bytes | None:
        """Return what has arrived; None when the other side is gone."""
        try:
            return self._socket.recv(_BYTES) or None
        except BlockingIOError:
            return b""
        except OSError:
            return None


class Words(NamedTuple):
    """What the watchdog said since the last look."""

    hears: bool | None
    """whether it hears the bus; None when it said nothing of that"""
    stops: tuple[Stop, ...] = ()
    cut: bool = False
    """whether it has cut the chip's outputs, where it said anything of the bus"""


class ActuatorEnd(End):
    """Reports every step, and hears whether somebody watches."""

    def __init__(self, file: socket.socket) -> None:
        super().__init__(file)
        self._rest = b""

    def report(self, report: Report) -> None:
        self._send(_REPORT.pack(report.stepped, report.stopped, *report.standing))

    def read(self) -> Words:
        """Return what arrived; raises DeviceError when the watchdog is gone, or cannot be understood."""
        data = self._read()
        if data is None:
            raise gone()
        self._rest += data
        hears, cut, stops = None, False, []
        while self._rest:
            word, length = self._rest[:1], 1
            if word == STOP:
                length = _STOP_HEAD.size + int.from_bytes(self._rest[1 : _STOP_HEAD.size], "little")
                if len(self._rest) < max(length, _STOP_HEAD.size):
                    break
                stops.append(_stop(self._rest[_STOP_HEAD.size : length]))
            else:
                hears, cut = word in (HEARS, CUT[HEARS]), word in CUT.values()
            self._rest = self._rest[length:]
        return Words(hears, tuple(stops), cut)


class WatchdogEnd(End):
    """Says that it watches, and hears each step."""

    def __init__(self, file: socket.socket) -> None:
        super().__init__(file)
        self._rest = b""

    def send(self, word: bytes) -> None:
        self._send(word)

    def stop(self, stop: Stop) -> None:
        said = msgspec.json.encode(stop)
        self._send(_STOP_HEAD.pack(STOP, len(said)) + said)

    def read(self) -> Report | None:
        """Return the newest report that arrived; raises EOFError when the actuator is gone."""
        data = self._read()
        if data is None:
            raise EOFError
        data = self._rest + data
        whole = len(data) // _REPORT.size * _REPORT.size
        self._rest = data[whole:]
        return _report(data, whole - _REPORT.size) if whole else None


def _report(data: bytes, start: int) -> Report:
    stepped, stopped, *standing = _REPORT.unpack_from(data, start)
    return Report(stepped, Standing(*standing), stopped)


def _stop(text: bytes) -> Stop:
    try:
        return msgspec.json.decode(text, type=Stop)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        raise DeviceError("the watchdog's stop cannot be read; the actuator ends, at rest") from None


def pair() -> tuple[WatchdogEnd, socket.socket]:
    """Return the watchdog's end, and the socket to hand to the actuator's process."""
    ours, theirs = socket.socketpair()
    return WatchdogEnd(ours), theirs


def adopt(number: int) -> ActuatorEnd:
    """Return the actuator's end, from the file descriptor it was started with."""
    return ActuatorEnd(socket.socket(fileno=number))
