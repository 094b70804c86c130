"""Floods of messages, and a machine that is busy with other things."""

import os
import sys
import time

from zteleop.chaos.bench import START, Bench, endpoint
from zteleop.chaos.fault import Act, Fault
from zteleop.chaos.people import press
from zteleop.chaos.processes import actuator, operator
from zteleop.errors import BusError

RATE = 20_000
WHILE = 3.0
"""s for which a load is watched"""
SPIN = "while True: pass"


def flood(*topics: str, rate: float = RATE, size: int = 100) -> Act:
    """Return what says so many messages a second, of so many bytes, on topics in turn."""

    def before(bench: Bench) -> None:
        arguments = [endpoint(bench.place.address), bench.place.robot, str(rate), str(size), *topics]
        process = bench.run("flood", [sys.executable, "-m", "zteleop.chaos.flood", *arguments])
        if bench.until(lambda: process.words == "floods", START) is None:
            raise BusError(f"there is no flood: {process.words}")

    return before


def work(bench: Bench) -> None:
    """Keep every core busy."""
    for number in range(os.cpu_count() or 1):
        bench.run(f"work-{number}", [sys.executable, "-c", SPIN])


def count_alarms(bench: Bench) -> str:
    """Watch for a while how often a robot comes to rest without a reason; that is a fault of its own."""
    alarms, rested = 0, False
    end = time.monotonic() + WHILE
    while time.monotonic() < end:
        rests = bench.eye.at_rest
        alarms += rests and not rested
        rested = rests
        time.sleep(0.001)
    return f"it came to rest {alarms} times in {WHILE:g} s without a reason" if alarms else ""


def tell_alarms(bench: Bench) -> None:
    """Count alarms on a machine that may really be too busy to drive: they are told."""
    if alarms := count_alarms(bench):
        bench.notes.append(alarms)


FLOOD = flood("cmd_vel/stranger")
KNOWN = flood("cmd_vel/keyboard")
CROWD = flood(*(f"chatter_{number}" for number in range(100)), rate=2000)
LARGE = flood("odom", rate=5, size=10_000_000)

FAULTS = (
    Fault("flood of a stranger", count_alarms, None, "drives", before=FLOOD),
    Fault("stop pressed in that flood", press, before=FLOOD),
    Fault("flood under the operator's name", count_alarms, None, "drives", before=KNOWN),
    Fault("stop pressed in that flood too", press, before=KNOWN),
    Fault("a hundred talkers", count_alarms, None, "drives", before=CROWD),
    Fault("messages of 10 MB", count_alarms, None, "drives", before=LARGE),
    Fault("every core busy", tell_alarms, None, "drives", before=work),
    Fault("every core busy, stop pressed", press, before=work),
    Fault("every core busy, actuator killed", actuator(9), before=work),
    Fault("every core busy, operator killed", operator(9), before=work, operator="program"),
)
