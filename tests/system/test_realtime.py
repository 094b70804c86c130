"""How the threads of a running robot are scheduled, as the kernel tells it."""

import os
import re
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from bench import Bench
from processes import part
from rig import Rig, until

from zteleop.machine.realtime import FEEDERS
from zteleop.processes import PROGRAMS

if sys.platform != "linux":
    pytest.skip("asks Linux", allow_module_level=True)

ZENOH = re.compile(r"(app|rx|tx|net|acc)-\d+")
"""The names that zenoh gives its threads; Python before 3.14 gives none."""
Rank = tuple[int, int]
WATCHDOG, ACTUATOR, DOOR = (
    (os.SCHED_FIFO, PROGRAMS[name].priority) for name in ("watchdog", "actuator", "door")
)
FEEDS, BEHIND, ORDINARY = (os.SCHED_RR, FEEDERS), (os.SCHED_FIFO, 1), (os.SCHED_OTHER, 0)


def permitted() -> bool:
    """Say whether a process that is started here may run first; a child finds out."""
    child = os.fork()
    if not child:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PROGRAMS["watchdog"].priority))
        finally:
            os._exit(os.sched_getscheduler(0) != os.SCHED_FIFO)
    return os.waitpid(child, 0)[1] == 0


pytestmark = pytest.mark.skipif(not permitted(), reason="real-time priority is not permitted here")


def threads(pid: int) -> Iterator[tuple[bool, Rank]]:
    """Yield each thread but the main one: is it zenoh's, and how is it scheduled?"""
    for task in Path(f"/proc/{pid}/task").iterdir():
        if int(task.name) != pid:
            yield bool(ZENOH.fullmatch((task / "comm").read_text().strip())), rank(int(task.name))


def rank(tid: int) -> Rank:
    return os.sched_getscheduler(tid) & ~os.SCHED_RESET_ON_FORK, os.sched_getparam(tid).sched_priority


def zenohs(pid: int) -> list[Rank]:
    return [rank for is_zenohs, rank in threads(pid) if is_zenohs]


def pythons(pid: int) -> list[Rank]:
    return [rank for is_zenohs, rank in threads(pid) if not is_zenohs]


def test_what_brings_commands_runs_first_and_what_writes_disks_and_logs_does_not(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    watchdog, child = bench.watchdog.process.pid, bench.watchdog.child
    assert child
    with bench.driven():
        until(lambda: bench.watchdog.recorder, "a black box")
        box, door = bench.watchdog.recorder or 0, bench.watchdog.door or 0
        assert (rank(watchdog), rank(child), rank(door)) == (WATCHDOG, ACTUATOR, DOOR)
        assert set(zenohs(door)) == {FEEDS}
        # Whoever steps the chip, or guards it, has nothing of zenoh's, and waits for no thread.
        assert zenohs(watchdog) == zenohs(child) == zenohs(box) == []
        # The journal shares the interpreter with the loop, and comes right behind it; the voice may wait.
        assert sorted(pythons(child)) == sorted([BEHIND, ORDINARY])
        assert set(pythons(watchdog)) <= {ORDINARY}
        assert set(pythons(door)) <= {ORDINARY}
        assert {rank(box), *pythons(box)} == {ORDINARY}


def test_who_asks_for_nothing_stays_ordinary(rig: Rig) -> None:
    rig.actuator()
    program = rig.join("pub", "cmd_vel", "Twist", "{}", "-r", "10")
    program.says("publishing #2")
    pid = program.process.pid
    assert {rank(pid), *zenohs(pid), *pythons(pid)} == {ORDINARY}


@pytest.mark.parametrize(("program", "its"), [(b"actuator", ACTUATOR), (b"door", DOOR)])
def test_what_its_watchdog_starts_again_runs_as_the_first_did(rig: Rig, program: bytes, its: Rank) -> None:
    watchdog = rig.actuator().process.pid
    first = part(watchdog, program)
    assert first
    os.kill(first, signal.SIGKILL)
    until(lambda: part(watchdog, program) not in (None, first), "another")
    again = part(watchdog, program) or 0
    until(lambda: rank(again) == its, "its rank")
    assert set(zenohs(again)) <= {FEEDS}
