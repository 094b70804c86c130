"""What a command costs a person who waits for it: from the start of its process to its end, or its answer."""

import subprocess
import sys
import time
from collections.abc import Sequence

from figures import is_quick, median, p99, paced, print_table, verdict
from processes import running
from raw_line import ONE_THREAD
from robot import ROBOT, ZTELEOP, Robot

RAW_ECHO = """
import argparse, json, msgspec, zenoh
parser = argparse.ArgumentParser()
parser.add_argument("key")
parser.add_argument("-e", "--connect")
arguments = parser.parse_args()
config = zenoh.Config()
for name, value in {"mode": "peer", "connect/endpoints": [arguments.connect], "scouting/delay": 0,
                    "scouting/multicast/enabled": False, "transport/shared_memory/enabled": False}.items():
    config.insert_json5(name, json.dumps(value))
with zenoh.open(config) as session:
    sample = session.declare_subscriber(arguments.key, zenoh.handlers.RingChannel(10)).recv()
    print(msgspec.json.decode(sample.payload.to_bytes()))
"""
PROGRAM = """
import sys
from zteleop import BusSettings, Node
from zteleop.messages import Beat
with Node("nose", {robot!r}, BusSettings(connect=[sys.argv[1]], multicast=False)) as node:
    print(next(iter(node.subscription("beat", Beat))), flush=True)
"""
HEAD = ("command", "p50", "slowest", "over python", "of the peer", "target here")
PYTHON, PEER = "python -c pass", "peer: raw zenoh + msgspec + argparse"
STOP, FIRST = "zteleop stop, to its answer", "a program's Node, to the first message it hears"
ANSWERS = (STOP, FIRST)
"""which are timed to their first line: what comes after that, nobody waits for"""
Told = tuple[str, Sequence[str], float | None]


def commands(endpoint: str) -> list[Told]:
    """Return what is timed: its name, its command, and the ms it may take beside a quick Python."""
    where = ["-e", endpoint, "--no-multicast-scouting"]
    topic, raw_echo = f"{ROBOT}/beat", [sys.executable, "-c", RAW_ECHO]
    return [
        (PYTHON, [sys.executable, "-c", "pass"], None),
        ("zteleop --help", [ZTELEOP, "--help"], 40),
        ("zteleop echo --once", [ZTELEOP, "echo", topic, "--once", *where], 120),
        (PEER, [*raw_echo, f"robot/{topic}", "-e", endpoint], None),
        ("zteleop list", [ZTELEOP, "list", *where], 120),
        (STOP, [ZTELEOP, "stop", ROBOT, *where], 70),
        (FIRST, [sys.executable, "-c", PROGRAM.format(robot=ROBOT), endpoint], 100),
        ("(python -c 'import zenoh, msgspec')", [sys.executable, "-c", "import zenoh, msgspec"], None),
    ]


def time_commands(runs: int) -> dict[str, list[float]]:
    """Return the ms of each run of each command, taken in turn."""
    with Robot() as robot:
        environment = robot.environment | {"ZENOH_RUNTIME": ONE_THREAD}
        told = commands(robot.endpoint)
        samples: dict[str, list[float]] = {name: [] for name, _, _ in told}
        for _ in range(runs):
            for name, command, _ in told:
                began = time.perf_counter()
                with running(command, stdout=subprocess.PIPE, env=environment, cwd=robot.folder) as process:
                    if name in ANSWERS:
                        failed = not (process.stdout and process.stdout.readline())
                    else:
                        process.communicate(timeout=10)
                        failed = bool(process.returncode)
                    samples[name].append(1000 * (time.perf_counter() - began))
                if failed:
                    raise SystemExit(f"{name} ended with {process.returncode}, or without a word")
            release = [ZTELEOP, "stop", ROBOT, "--release", "-e", robot.endpoint, "--no-multicast-scouting"]
            subprocess.run(release, env=environment, cwd=robot.folder, check=True, capture_output=True)
    return samples


def main() -> None:
    runs = 3 if is_quick(__doc__) else 20
    samples = time_commands(runs)
    python, peer = median(samples[PYTHON]), median(samples[PEER])
    rows = []
    for name, _, most in commands(""):
        p50 = median(samples[name])
        target = verdict(p50, paced(most, python), "ms") if most else ""
        rows.append((name, p50, p99(samples[name]), p50 - python, p50 / peer, target))
    print_table(f"start to end, or to the answer, ms, {runs} runs in turn", HEAD, rows)
    print("a topic that is said 20 times a second costs 25 ms of waiting on the average")


if __name__ == "__main__":
    main()
