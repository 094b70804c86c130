"""A machine as slow as a Pi Zero 2, imitated: does a robot that is driven there drive, and stop in time?

On each core somebody of a priority above everything spins for most of each 4 ms, so that all else, the
robot's own real-time threads too, gets an eighth of it: what one thread gets on a Pi Zero 2, and on two
cores where that has four. Neither its memory nor its card is imitated. For root, on Linux.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import key_to_wheel
from figures import command_line, median, p99, print_table
from processes import running
from robot import ZTELEOP

SLOWER = 8.0
"""times, as a Pi Zero 2 is than a core of a laptop"""
PRIORITY = 90
"""of those who spin: above the robot's own"""
SLICE = 0.004
"""s, of which all else gets its part"""
SPIN = "--spin"
FAULTS = "processes"
"""those of the certificate that are done"""


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--slower", type=float, default=SLOWER, metavar="TIMES", help=f"default: {SLOWER:g}")
    options = parser.parse_args()
    with slowed(options.slower):
        python = time_python()
        rows = [*keys(1 if options.quick else 8), *demo(), *certificate(1 if options.quick else 3)]
    title = f"{options.slower:g} times slower: `python -c pass` takes {python:.0f} ms"
    print_table(title, ["what", "median ms", "p99, worst ms", "at most", "what came of it"], rows)


def keys(rounds: int) -> Iterator[list[object]]:
    """Yield how long a key takes to the wheel, both processes on the slow machine."""
    ours, raw = key_to_wheel.time_lines(rounds)
    yield ["key to wheel", median(ours), p99(ours), "", f"{median(ours) / median(raw):.1f} x raw zenoh"]
    yield ["the same, raw zenoh", median(raw), p99(raw), "", ""]


def demo() -> Iterator[list[object]]:
    """Yield what a demo without a terminal comes to: it drives a figure, and ends by itself."""
    ended = subprocess.run(
        [ZTELEOP, "demo"], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    )
    said = (ended.stderr if ended.returncode else ended.stdout).splitlines()
    yield ["demo", "", "", "", f"exit code {ended.returncode}: {said[-1] if said else 'no word'}"]


def certificate(times: int) -> Iterator[list[object]]:
    """Yield each fault of the certificate that is about processes."""
    with tempfile.TemporaryDirectory(prefix="zteleop-slow-") as folder:
        found = subprocess.run(
            [ZTELEOP, "chaos", "--only", FAULTS, "--times", f"{times}", "--json"],
            capture_output=True,
            text=True,
            check=False,
            cwd=folder,
        )
    for one in json.loads(found.stdout)["verdicts"]:
        yield [one["fault"], *(_ms(one[name]) for name in ("median", "worst", "bound")), _verdict(one)]


def _verdict(one: dict[str, Any]) -> str:
    """Return what came of a fault, which may be nothing: there everything waits for a core."""
    waited = f"{1000 * one['longest_wait']:.0f} ms at most"
    void = f"{one['void']} void: late by what they waited for a core, {waited}"
    if one["broken"]:
        return f"BROKEN: {one['broken'][0]}"
    return (f"kept, {void}" if one["void"] else "kept") if one["times"] else f"NOT JUDGED, {void}"


def time_python() -> float:
    """Return the ms that a bare Python takes from start to end."""
    times = []
    for _ in range(10):
        began = time.perf_counter()
        subprocess.run([sys.executable, "-c", "pass"], check=True)
        times.append(1000 * (time.perf_counter() - began))
    return median(times)


def _ms(seconds: float | None) -> float | str:
    return "" if seconds is None else 1000 * seconds


@contextmanager
def slowed(slower: float) -> Iterator[None]:
    """Make the machine so many times slower for as long as a `with` lasts."""
    with ExitStack() as stack:
        for core in sorted(os.sched_getaffinity(0)):
            stack.enter_context(running([sys.executable, __file__, SPIN, f"{core}", f"{slower}"]))
        time.sleep(0.5)
        yield


def spin(core: int, slower: float) -> None:
    """Take a core for itself, but for one part in so many."""
    os.sched_setaffinity(0, {core})
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    Path("/proc/self/timerslack_ns").write_text("1")
    while True:
        until = time.perf_counter() + SLICE * (1 - 1 / slower)
        while time.perf_counter() < until:
            pass
        time.sleep(SLICE / slower)


if __name__ == "__main__":
    if SPIN in sys.argv:
        spin(int(sys.argv[2]), float(sys.argv[3]))
    main()
