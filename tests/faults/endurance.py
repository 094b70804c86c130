"""Half an hour of floods: does any process of the robot grow, and can it still be driven and stopped?

`python -m faults.endurance --minutes 30`
"""

import argparse
import sys
import time
from pathlib import Path

from zteleop.chaos.bench import Bench, Subject
from zteleop.chaos.load import CROWD, FLOOD, KNOWN, LARGE
from zteleop.chaos.operators import here
from zteleop.chaos.people import press
from zteleop.config import Config
from zteleop.processes import PROGRAMS

MOST = 10.0
"""MB that a process may grow"""
WARM, EVERY = 60.0, 120.0
"""s after which what is there counts as there from the start; s between two looks"""
BOUND = 0.05


def private_mb(pid: int) -> float:
    """Return the memory that is a process's own."""
    lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    return sum(int(line.split()[1]) for line in lines if line.startswith("Private_")) / 1024


def family(pid: int) -> list[int]:
    """Return a process and whoever it has started."""
    return [pid, *map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())]


def name(pid: int) -> str:
    """Return what a process of the robot does."""
    command = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
    return next((name for name in PROGRAMS if name.encode() in command[3:]), "watchdog")


def main() -> int:
    """Return 0 when nobody grew too much, and it stopped in time at the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    minutes = parser.parse_args().minutes
    if minutes < 4:
        parser.error("at least 4 minutes are meant, for two looks at the memory")
    with Bench(Subject(Config(), ("--driver", "simulated"))) as bench, here(bench):
        bench.until(lambda: not bench.eye.at_rest, 10.0)
        time.sleep(5.0)  # until the black box is there as well
        for flood in (FLOOD, KNOWN, CROWD, LARGE):
            flood(bench)
        began, alarms, rested = time.monotonic(), 0, False
        first: dict[int, float] = {}
        newest: dict[int, float] = {}
        tell_at = WARM
        while (passed := time.monotonic() - began) < 60 * minutes:
            rests = bench.eye.at_rest
            alarms, rested = alarms + (rests and not rested), rests
            if passed >= tell_at:
                tell_at += EVERY
                newest = {pid: private_mb(pid) for pid in family(bench.watchdog.pid)}
                first = first or newest
                figures = ", ".join(f"{name(pid)} {size:.1f} MB" for pid, size in newest.items())
                print(f"{passed / 60:5.1f} min: {figures}, at rest {alarms} times", flush=True)
            time.sleep(0.01)
        struck = time.monotonic()
        press(bench)
        stopped = bench.until(lambda: bench.eye.at_rest, 5.0)
    took = (stopped or float("inf")) - struck
    grown = max(newest.get(pid, float("inf")) - before for pid, before in first.items())
    print(
        f"grown by {grown:.1f} MB at most, came to rest {alarms} times, stopped within {1000 * took:.1f} ms"
    )
    return 0 if grown <= MOST and took <= BOUND and set(newest) == set(first) else 1


if __name__ == "__main__":
    sys.exit(main())
