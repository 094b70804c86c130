"""Are lists complete at once where there is much, and do hz and pub keep time?"""

import re
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise

from figures import is_quick, median, p99, print_table, verdict
from processes import running
from robot import ROBOT, ZTELEOP, Robot

from zteleop.bus import presence
from zteleop.bus.names import Name
from zteleop.bus.node import Node
from zteleop.bus.session import open_session
from zteleop.bus.settings import BusSettings
from zteleop.messages import String

NODES, TOPICS = 200, 5
LIST_MS, WITHIN = 500, 1.0
RATES_HZ = (1.0, 50.0, 500.0)
SAID_HZ = 100.0


def where(robot: Robot) -> list[str]:
    return ["--robot", ROBOT, "-e", robot.endpoint, "--no-multicast-scouting"]


def bus(robot: Robot) -> BusSettings:
    return BusSettings(connect=[robot.endpoint], multicast=False)


def time_list(robot: Robot, runs: int) -> list[float]:
    """Return the ms that `list` takes beside many nodes, each time with every one of their topics."""
    taken = []
    with open_session(bus(robot)) as session:
        for node in range(NODES):
            for topic in range(TOPICS):
                name = Name(ROBOT, f"n{node}_t{topic}")
                session.declare_token(presence.endpoint_key(name, "pub", f"n{node}", (String,)))
        for _ in range(runs):
            began = time.perf_counter()
            command = [ZTELEOP, "list", *where(robot)]
            done = subprocess.run(command, env=robot.environment, capture_output=True, text=True, check=True)
            taken.append(1000 * (time.perf_counter() - began))
            found = len(re.findall(r"^/bench/n\d+_t\d$", done.stdout, re.MULTILINE))
            if found != NODES * TOPICS:
                raise SystemExit(f"list was not complete: {found} of {NODES * TOPICS}")
    return taken


@contextmanager
def said(robot: Robot, rate_hz: float) -> Iterator[None]:
    """Say something on a schedule that never slips."""
    ended = threading.Event()
    with Node("talker", ROBOT, bus(robot)) as node:
        node.log.show = lambda line: None
        chatter = node.publisher("chatter", String)

        def talk() -> None:
            due = time.monotonic()
            while not ended.wait(max(0.0, due - time.monotonic())):
                due += 1 / rate_hz
                chatter.publish(String("x"))

        talker = threading.Thread(target=talk)
        talker.start()
        try:
            yield
        finally:
            ended.set()
            talker.join()


def measure_hz(robot: Robot, rate_hz: float, lines: int) -> float:
    """Return what `hz` says of a rate, by so many of its lines."""
    with said(robot, rate_hz):
        command = [ZTELEOP, "hz", "chatter", *where(robot)]
        with running(command, stdout=subprocess.PIPE, env=robot.environment, cwd=robot.folder) as process:
            assert process.stdout
            found = 0.0
            while lines:
                if rate := re.match(r"average rate: ([0-9.]+)", process.stdout.readline()):
                    found, lines = float(rate[1]), lines - 1
            return found


def measure_pub(robot: Robot, seconds: float) -> tuple[float, float]:
    """Return the rate of `pub -r 100`, and the 99th percentile of how far a gap is from its period, in ms."""
    times: list[float] = []
    with open_session(bus(robot)) as session:
        ring = session.subscribe(f"robot/{ROBOT}/spoken", 10_000)
        command = [ZTELEOP, "pub", "spoken", "String", "-r", f"{SAID_HZ:g}", "-w", "0", *where(robot)]
        with running(command, stdout=subprocess.DEVNULL, env=robot.environment, cwd=robot.folder):
            while not times or times[-1] - times[0] < seconds:
                ring.recv()
                times.append(time.monotonic())
    gaps = [after - before for before, after in pairwise(times)]
    return len(gaps) / (times[-1] - times[0]), p99([1000 * abs(gap - 1 / SAID_HZ) for gap in gaps])


def main() -> None:
    quick = is_quick(__doc__)
    with Robot() as robot:
        lists = time_list(robot, 3 if quick else 20)
        rates = [(rate, measure_hz(robot, rate, 3 if quick else 10)) for rate in RATES_HZ]
        rate_hz, jitter_ms = measure_pub(robot, 3.0 if quick else 20.0)
    rows = [
        (
            f"zteleop list, {NODES * TOPICS} topics of {NODES} nodes, complete each time",
            f"{median(lists):.0f} ms",
            verdict(median(lists), LIST_MS, "ms"),
        )
    ]
    for rate, found in rates:
        off = 100 * abs(found - rate) / rate
        rows.append((f"zteleop hz of {rate:g} Hz", f"{found:.3f} Hz", verdict(off, WITHIN, "% off")))
    off = 100 * abs(rate_hz - SAID_HZ) / SAID_HZ
    rows.append((f"zteleop pub -r {SAID_HZ:g}", f"{rate_hz:.2f} Hz", verdict(off, WITHIN, "% off")))
    rows.append(("... how far its gaps are from their period, p99", f"{jitter_ms:.2f} ms", ""))
    print_table("the graph and the time", ["what", "found", "target"], rows)


if __name__ == "__main__":
    main()
