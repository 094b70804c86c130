"""Does what anybody on an open network can do to a robot, until its process is ended.

`python -m zteleop.chaos.stranger ATTACK ENDPOINT ROBOT`; says "strikes" when it has begun.
"""

import os
import signal
import socket
import sys
import time
from collections.abc import Callable
from contextlib import suppress

import zenoh

from zteleop.bus import codec
from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import open_zenoh
from zteleop.bus.zenoh_session import ZenohSession
from zteleop.chaos.spoiler import dial, poison
from zteleop.control.proof import Prover
from zteleop.errors import BusError
from zteleop.messages import Beat, Twist

GARBAGE_HZ, CHURN_HZ, NEUTRAL_HZ = 50, 1800, 4000
CONNECTIONS, SUBSCRIBERS, SESSIONS, SENDERS = 200, 10, 300, 200
TWIST = f"application/json;{Twist.ros_type}"


def join(endpoint: str, patience: float = 3.0) -> zenoh.Session:
    return open_zenoh(BusSettings(mode="client", connect=[endpoint], multicast=False, patience=patience))


def strike() -> None:
    """Say that it has begun."""
    os.write(1, b"strikes\n")


def at(rate: float, act: Callable[[int], object]) -> None:
    """Do something so often a second, in bunches where the machine sleeps no shorter."""
    strike()
    in_a_row = max(1, round(rate / 500))
    number, due = 0, time.monotonic()
    while True:
        for _ in range(in_a_row):
            act(number)
            number += 1
        due += in_a_row / rate
        time.sleep(max(0.0, due - time.monotonic()))


def declare_what_is_none(endpoint: str, robot: str) -> None:
    """Declare what is no key expression, once, and leave."""
    poison(endpoint)
    strike()
    signal.pause()


def idle_connections(endpoint: str, robot: str) -> None:
    """Connect, and say nothing; whoever is let go comes again."""
    held: list[socket.socket] = []

    def connect(number: int) -> None:
        with suppress(OSError):
            held.append(dial(endpoint))
        if len(held) > CONNECTIONS:
            held.pop(0).close()

    at(100, connect)


def garbage_beats(endpoint: str, robot: str) -> None:
    """Say what is no beat where beats are said."""
    session = join(endpoint)
    beats = session.declare_publisher(f"robot/{robot}/beat")
    at(GARBAGE_HZ, lambda number: beats.put(b"twenty bytes of none"))


def churning_tokens(endpoint: str, robot: str) -> None:
    """Come and go as a sender of commands."""
    session = ZenohSession(join(endpoint))

    def come_and_go(number: int) -> None:
        session.stand(f"robot/{robot}/live/sender/{number % 1000:x}").undeclare()

    at(CHURN_HZ, come_and_go)


def stalled_subscribers(endpoint: str, robot: str) -> None:
    """Subscribe to everything, and stand still."""
    held = []
    for _ in range(SUBSCRIBERS):
        config = zenoh.Config()
        for key, value in {
            "mode": '"client"',
            "connect/endpoints": f'["{endpoint}"]',
            "scouting/multicast/enabled": "false",
            "transport/link/tx/lease": "3600000",
        }.items():
            config.insert_json5(key, value)
        session = zenoh.open(config)
        held.append((session, session.declare_subscriber("**", zenoh.handlers.RingChannel(1))))
    time.sleep(0.5)
    strike()
    os.kill(os.getpid(), signal.SIGSTOP)


def idle_sessions(endpoint: str, robot: str) -> None:
    """Join a few hundred times, or as often as one is let in, and say nothing."""
    held: list[zenoh.Session] = []
    with suppress(BusError):
        while len(held) < SESSIONS:
            held.append(join(endpoint, patience=0.0))
    strike()
    signal.pause()


def many_senders(endpoint: str, robot: str) -> None:
    """Say neutral, with good proofs, under many names."""
    session = join(endpoint)
    beats = session.declare_subscriber(f"robot/{robot}/beat", zenoh.handlers.RingChannel(1))
    commands = session.declare_publisher(f"robot/{robot}/cmd_vel/program")
    provers, newest = [Prover(1000 + number) for number in range(SENDERS)], beats.recv()
    rest = codec.encode(Twist.planar())

    def say(number: int) -> None:
        nonlocal newest
        newest = beats.try_recv() or newest
        beat = codec.decode(bytes(newest.payload), str(newest.encoding), codec.decoders([Beat]))
        assert isinstance(beat, Beat)
        proof = provers[number % SENDERS].prove(beat, False, time.monotonic())
        commands.put(rest, encoding=TWIST, attachment=codec.pack_proof(proof) if proof else None)

    at(NEUTRAL_HZ, say)


ATTACKS: dict[str, Callable[[str, str], None]] = {
    "a declaration that is none": declare_what_is_none,
    "connections that say nothing": idle_connections,
    "garbage on the beat": garbage_beats,
    "tokens that come and go": churning_tokens,
    "subscribers that stand still": stalled_subscribers,
    "sessions that say nothing": idle_sessions,
    "neutral under many names": many_senders,
}
"""As people call them, and what does them."""

if __name__ == "__main__":
    ATTACKS[sys.argv[1]](*sys.argv[2:])
