"""What anybody on an open network can do to a robot, each until the process is ended.

`python benchmarks/stranger.py ATTACK ENDPOINT ROBOT`; says "strikes" when it has begun.
"""

import os
import signal
import socket
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import zenoh

from zteleop.bus import codec
from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_session import open_zenoh
from zteleop.control.proof import Prover
from zteleop.messages import Beat, Twist

GARBAGE_HZ, CHURN_HZ, NEUTRAL_HZ = 50, 1800, 4000
CONNECTIONS, SUBSCRIBERS, SESSIONS, SENDERS = 200, 10, 300, 200
TWIST = f"application/json;{Twist.ros_type}"


def join(endpoint: str) -> zenoh.Session:
    return open_zenoh(BusSettings(mode="client", connect=[endpoint], multicast=False))


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


def poison(endpoint: str, robot: str) -> None:
    """Declare what is no key expression, once, and leave."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    from faults import poison as ways

    ways.poison(int(endpoint.rpartition(":")[2]))
    strike()
    signal.pause()


def idle_connections(endpoint: str, robot: str) -> None:
    """Connect, and say nothing; whoever is let go comes again."""
    port = int(endpoint.rpartition(":")[2])
    held: list[socket.socket] = []

    def connect(number: int) -> None:
        with suppress(OSError):
            held.append(socket.create_connection(("127.0.0.1", port), timeout=1.0))
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
    session = join(endpoint)

    def come_and_go(number: int) -> None:
        session.liveliness().declare_token(f"robot/{robot}/live/sender/{number % 1000:x}").undeclare()

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
    """Join, a few hundred times, and say nothing."""
    held = [join(endpoint) for _ in range(SESSIONS)]
    strike()
    assert held
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
        proof = provers[number % SENDERS].prove(beat, False, time.monotonic())
        commands.put(rest, encoding=TWIST, attachment=codec.pack_proof(proof) if proof else None)

    at(NEUTRAL_HZ, say)


ATTACKS = {
    "a declaration that is none": poison,
    "connections that say nothing": idle_connections,
    "garbage on the beat": garbage_beats,
    "tokens that come and go": churning_tokens,
    "subscribers that stand still": stalled_subscribers,
    "sessions that say nothing": idle_sessions,
    "neutral under many names": many_senders,
}

if __name__ == "__main__":
    ATTACKS[sys.argv[1]](*sys.argv[2:])
