"""What a stranger does to zenoh: a key expression that is none, spoilt after the client's own check."""

import socket
import threading
import time
from contextlib import closing, suppress
from typing import Self

import zenoh
from processes import PATIENCE
from rig import free_port

from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_session import open_zenoh

SOUND, SPOILT = b"spoilt", b"#@$*$#"
"""as long as each other: zenoh's frames say their length, and nothing else of what is in them"""
PIECE = 65536


class Spoiler:
    """Relays connections to a port of this machine, and spoils a name in what is said to it."""

    def __init__(self, target: int) -> None:
        self._target, self.port = target, free_port()
        self._listener = socket.create_server(("127.0.0.1", self.port))
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
                    theirs = socket.create_connection(("127.0.0.1", self._target))
                except OSError:  # whom this poisoned is gone
                    ours.close()
                    continue
                for source, sink, spoils in ((ours, theirs, True), (theirs, ours, False)):
                    threading.Thread(target=self._relay, args=(source, sink, spoils), daemon=True).start()

    def _relay(self, source: socket.socket, sink: socket.socket, spoils: bool) -> None:
        with closing(source), closing(sink), suppress(OSError):
            while data := source.recv(PIECE):
                sink.sendall(data.replace(SOUND, SPOILT) if spoils else data)


def poison(port: int) -> None:
    """Declare a key expression that is none to whoever listens at a port, and leave."""
    with Spoiler(port) as spoiler:
        bus = BusSettings(mode="client", connect=[f"tcp/127.0.0.1:{spoiler.port}"], multicast=False)
        with open_zenoh(bus) as session:
            session.declare_subscriber(f"robot/bench/{SOUND.decode()}", zenoh.handlers.RingChannel(1))
            session.declare_subscriber("robot/bench/sound", zenoh.handlers.RingChannel(1))
            time.sleep(0.5)  # a poisoned robot answers nothing


def is_deaf(port: int) -> bool:
    """Say whether a newcomer's declarations are heard no more, which is what the poison does."""
    bus = BusSettings(mode="client", connect=[f"tcp/127.0.0.1:{port}"], multicast=False)
    with open_zenoh(bus) as session:
        inbox = session.declare_subscriber("robot/*/beat", zenoh.handlers.RingChannel(1))
        give_up = time.monotonic() + min(1.0, PATIENCE)
        while time.monotonic() < give_up:
            if inbox.try_recv() is not None:
                return False
            time.sleep(0.01)
    return True
