"""The least that stands between a key and a register: read, raw zenoh put, recv, write. Started by others.

python raw_line.py key ENDPOINT | wheel ENDPOINT FILE | flood ENDPOINT KEY PROOF SECONDS
"""

import json
import os
import select
import struct
import sys
import time
import tty
from mmap import mmap

ONE_THREAD = (
    "(rx:(handover:app),acc:(handover:app),tx:(handover:app),net:(handover:app),app:(worker_threads:1))"
)
os.environ.setdefault("ZENOH_RUNTIME", ONE_THREAD)

import zenoh  # noqa: E402 - it reads the variable when it is imported

LED0_ON_L = 6
KEY = "robot/bench/raw"
RATE = 20_000
BATCH = 20
FOREIGN = b'{"linear":{"x":0.5,"y":0.0,"z":0.0},"angular":{"x":0.0,"y":0.0,"z":0.5}}'


def open_session(**values: object) -> zenoh.Session:
    """Open zenoh as zteleop does."""
    config = zenoh.Config()
    values = {"scouting/multicast/enabled": False, "scouting/delay": 0, "mode": "peer"} | values
    values |= {"transport/shared_memory/enabled": False}
    values |= {"transport/link/tx/lease": 1000, "transport/link/tx/keep_alive": 4}
    for key, value in values.items():
        config.insert_json5(key, json.dumps(value))
    return zenoh.open(config)


def key(endpoint: str) -> None:
    with open_session(**{"connect/endpoints": [endpoint]}) as session:
        publisher = declare(session, KEY)
        tty.setraw(0)
        os.write(1, b"ready")
        presses = 0
        while True:
            select.select([0], [], [])
            os.read(0, 4096)
            presses += 1
            publisher.put(bytes((0, 0, presses % 2, 1)))


def wheel(endpoint: str, path: str) -> None:
    memory = mmap(os.open(path, os.O_RDWR), 256)
    with open_session(**{"listen/endpoints": [endpoint]}) as session:
        subscriber = session.declare_subscriber(KEY, zenoh.handlers.RingChannel(10))
        memory[LED0_ON_L] = 1
        while True:
            memory[LED0_ON_L + 4 : LED0_ON_L + 8] = subscriber.recv().payload.to_bytes()


def flood(endpoint: str, name: str, proof: str, seconds: str) -> None:
    """Say the same command RATE times a second; print the rate really reached."""
    with open_session(**{"connect/endpoints": [endpoint]}) as session:
        publisher = declare(session, f"robot/bench/{name}")
        encoding = zenoh.Encoding("application/json;geometry_msgs/msg/Twist")
        attachment = stale_proof(session) if proof == "stale" else None
        time.sleep(0.5)
        print("ready", flush=True)
        began, said = time.perf_counter(), 0
        while (elapsed := time.perf_counter() - began) < float(seconds):
            if said > elapsed * RATE:
                time.sleep(BATCH / RATE / 2)
                continue
            for _ in range(BATCH):
                publisher.put(FOREIGN, encoding=encoding, attachment=attachment)
            said += BATCH
        print(said / elapsed, flush=True)


def stale_proof(session: zenoh.Session) -> bytes:
    """Return the proof of a beat that was heard a second ago."""
    beats = session.declare_subscriber("robot/bench/beat", zenoh.handlers.RingChannel(1))
    beat = json.loads(beats.recv().payload.to_bytes())
    time.sleep(1)
    return struct.pack("<QQQddd", 1, 1, beat["epoch"], *[beat["time"]] * 3)


def declare(session: zenoh.Session, name: str) -> zenoh.Publisher:
    """Declare a publisher as zteleop declares one for commands."""
    return session.declare_publisher(
        name,
        congestion_control=zenoh.CongestionControl.DROP,
        priority=zenoh.Priority.REAL_TIME,
        express=True,
    )


if __name__ == "__main__":
    {"key": key, "wheel": wheel, "flood": flood}[sys.argv[1]](*sys.argv[2:])
