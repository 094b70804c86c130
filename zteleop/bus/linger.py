"""No link waits for its other end when it is closed.

zenoh tells each TCP socket to linger: to close it may take ten seconds when the other end is silently gone,
in a thread that serves all links. Meanwhile nobody else is heard either, and nobody's stop.
"""

import atexit
import os
import socket
import stat
import struct
from collections.abc import Iterator
from contextlib import suppress

import zenoh

_TCP = (socket.AF_INET, socket.AF_INET6)
_NOT = struct.pack("ii", 0, 0)
"""Close at once; the kernel still sends what is left, and gives up by itself."""
_FILES = "/dev/fd"
"""This process's open files, on Linux and macOS; on Windows zenoh's sockets do not linger."""


def forbid(session: zenoh.Session) -> None:
    """Let no link of a session linger, neither those it has nor those to come."""
    callback = zenoh.handlers.Callback(_notice, indirect=False)
    listener = session.info.declare_link_events_listener(callback, history=True)
    atexit.register(_end, listener)


def _end(listener: "zenoh.LinkEventsListener[None]") -> None:
    """Hear of no link any more: Python ends, and the session may not be closed."""
    with suppress(zenoh.ZError):
        listener.undeclare()  # type: ignore[no-untyped-call]


def _notice(event: zenoh.LinkEvent) -> None:
    """Find the socket of a new link; runs in zenoh's thread."""
    if event.kind != zenoh.SampleKind.PUT or not event.link.is_streamed:
        return
    ports = (_port(str(event.link.src)), _port(str(event.link.dst)))
    for end in _sockets():
        with end, suppress(OSError):  # one that listens has no other end
            if (end.getsockname()[1], end.getpeername()[1]) == ports:
                end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _NOT)


def _port(locator: str) -> int | None:
    """Return the port of a locator such as tcp/[::1]:7447; None when it is another kind of place."""
    text = locator.partition("?")[0].partition("#")[0].rpartition(":")[2]
    return int(text) if text.isdecimal() else None


def _sockets() -> Iterator[socket.socket]:
    """Yield this process's TCP sockets, each by a handle of its own, which is to be closed."""
    with suppress(OSError):
        for name in os.listdir(_FILES):
            with suppress(OSError):  # gone meanwhile
                if stat.S_ISSOCK(os.stat(int(name)).st_mode):
                    end = socket.socket(fileno=os.dup(int(name)))
                    if end.family in _TCP and end.type == socket.SOCK_STREAM:
                        yield end
                    else:
                        end.close()
