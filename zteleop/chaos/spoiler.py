"""A declaration that is none: zenoh's clients check what they declare, so a relay spoils it on its way."""

import socket
import threading
import time
from contextlib import closing, suppress
from pathlib import Path
from typing import Self

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh
from zteleop.bus.zenoh_session import ZenohSession

SOUND, SPOILT = b"spoilt", b"#@$*$#"
"""as long as each other: zenoh's frames say their length, and nothing else of what is in them"""
PIECE = 65536
ANSWERS_WITHIN = 0.5
"""s; whoever is poisoned answers nothing"""


def dial(endpoint: str) -> socket.socket:
    """Connect to an endpoint, tcp/127.0.0.1:7447 or unixsock-stream/PATH; raises OSError."""
    kind, _, address = endpoint.partition("/")
    if kind == "tcp":
        host, _, port = address.rpartition(":")
        return socket.create_connection((host, int(port)), timeout=1.0)
    end = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        end.connect(str(Path(address)))
    except OSError:
        end.close()
        raise
    return end


class Spoiler:
    """Relays connections to an endpoint, and spoils a name in what is said to it."""

    def __init__(self, endpoint: str) -> None:
        self._target = endpoint
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self._listener.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                ours, _ = self._listener.accept()
                try:
                    theirs = dial(self._target)
                except OSError:  # whom this poisoned is gone
                    ours.close()
                    continue
                theirs.settimeout(None)
                for source, sink, spoils in ((ours, theirs, True), (theirs, ours, False)):
                    threading.Thread(target=_relay, args=(source, sink, spoils), daemon=True).start()


def _relay(source: socket.socket, sink: socket.socket, spoils: bool) -> None:
    with closing(source), closing(sink), suppress(OSError):
        while data := source.recv(PIECE):
            sink.sendall(data.replace(SOUND, SPOILT) if spoils else data)


def poison(endpoint: str) -> None:
    """Declare a key expression that is none to whoever listens at an endpoint, and leave."""
    with Spoiler(endpoint) as spoiler:
        bus = BusSettings(mode="client", connect=[f"tcp/127.0.0.1:{spoiler.port}"], multicast=False)
        with ZenohSession(open_zenoh(bus)) as session:
            rings = [session.subscribe(f"robot/bench/{name}", 1) for name in (SOUND.decode(), "sound")]
            time.sleep(ANSWERS_WITHIN)
            del rings  # until here: what nobody holds is undeclared
