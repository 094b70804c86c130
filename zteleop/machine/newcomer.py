"""A newcomer's try: does this process still take whoever connects to it?

What listens may be stuck while all who are in already are served, and nothing inside shows it.
"""

import os
import socket
import stat
from collections.abc import Iterable
from contextlib import suppress
from itertools import cycle
from typing import Any, NamedTuple

EVERY, LOOK_EVERY = 5.0, 0.1
"""s between tries, and between looks for an answer"""
LOOKS = 20
"""without an answer. They count, and not the time: who stood still has not looked, and nobody is to blame"""
NO_MESSAGE = b"\x06\x00" + bytes([255] * 6)
"""what neither zenoh nor TLS takes for a greeting: whoever is awake hangs up at once"""


class Listener(NamedTuple):
    """What somebody may connect to."""

    family: int
    address: Any


class Newcomer:
    """Connects to each listener in turn; to be turned away is an answer.

    A stranger can fill a listener's queue. So whoever does not get as far as being connected learns nothing.
    """

    def __init__(self, listeners: Iterable[Listener]) -> None:
        self._listeners = cycle(listeners)
        self._end: socket.socket | None = None
        self._due = float("-inf")
        self._looks = 0
        self._is_connected = False

    def is_let_in(self, now: float) -> bool:
        """Say whether newcomers are, as far as is known; to be asked every LOOK_EVERY s."""
        if self._end is None:
            if now >= self._due and (listener := next(self._listeners, None)):
                self._due = now + EVERY
                self._knock(listener)
            return True
        self._looks += 1
        if self._is_answered():
            self.close()
        elif self._looks == LOOKS:
            self.close()
            return not self._is_connected
        return True

    def close(self) -> None:
        if self._end:
            self._end.close()
        self._end = None

    def _knock(self, listener: Listener) -> None:
        self._looks, self._is_connected = 0, False
        try:
            self._end = socket.socket(listener.family, socket.SOCK_STREAM)
            self._end.setblocking(False)
            self._end.connect(listener.address)
        except BlockingIOError:
            return
        except OSError:  # no more files, or an address that is gone: none of the listener's fault
            self.close()

    def _is_answered(self) -> bool:
        assert self._end
        try:
            if not self._is_connected:
                self._end.send(NO_MESSAGE)
                self._is_connected = True
            self._end.recv(64)
        except BlockingIOError:
            return False
        except OSError:  # hung up on
            return True
        return True


def own_listeners() -> list[Listener]:
    """Return what this process listens at on the network, by TCP."""
    listeners = []
    for number in map(int, os.listdir("/dev/fd")):
        with suppress(OSError):  # it may be closed meanwhile
            if not stat.S_ISSOCK(os.fstat(number).st_mode):
                continue
            with socket.socket(fileno=os.dup(number)) as found:
                on_network = found.family in (socket.AF_INET, socket.AF_INET6)
                if on_network and found.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                    listeners.append(Listener(found.family, found.getsockname()))
    return listeners
