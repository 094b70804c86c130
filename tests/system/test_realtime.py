"""How the threads of a running robot are scheduled, as the kernel tells it."""

import os
import re
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from bench import Bench
from rig import Rig, until

from zteleop.machine.realtime import FEEDERS
from zteleop.processes import PROGRAMS

if sys.platform != "linux":
    pytest.skip("asks Linux", allow_module_level=True)

ZENOH = re.compile(r"(app|rx|tx|net|acc)-\d+")
"""The names that zenoh gives its threads; Python before 3.14 gives none."""
LEAST_INBOXES = 5
Rank = tuple[int, int]
WATCHDOG, ACTUATOR = (
    (os.SCHED_FIFO, PROGRAMS["watchdog"].priority),
    (os.SCHED_FIFO, PROGRAMS["actuator"].priority),
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


def recorder(watchdog: int) -> int | None:
    for child in Path(f"/proc/{watchdog}/task/{watchdog}/children").read_text().split():
        if b"--record" in Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0"):
            return int(child)
    return None


def test_what_brings_commands_runs_first_and_what_writes_disks_and_logs_does_not(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    watchdog, child = bench.watchdog.process.pid, bench.watchdog.child
    assert child
    with bench.driven():
        until(lambda: recorder(watchdog), "a black box")
        box = recorder(watchdog) or 0
        until(lambda: zenohs(box), "a black box that has joined the bus")
        assert (rank(watchdog), rank(child)) == (WATCHDOG, ACTUATOR)
        assert set(zenohs(watchdog)) == set(zenohs(child)) == {FEEDS}
        inboxes = pythons(child).count(FEEDS)
        assert inboxes >= LEAST_INBOXES
        # The journal shares the interpreter with the loop, and comes right behind it; the voice may wait.
        assert sorted(pythons(child)) == sorted([BEHIND, ORDINARY, *inboxes * [FEEDS]])
        assert set(pythons(watchdog)) <= {ORDINARY}
        assert {rank(box), *zenohs(box), *pythons(box)} == {ORDINARY}


def test_who_asks_for_nothing_stays_ordinary(rig: Rig) -> None:
    rig.actuator()
    program = rig.join("pub", "cmd_vel", "Twist", "{}", "-r", "10")
    program.says("publishing #2")
    pid = program.process.pid
    assert {rank(pid), *zenohs(pid), *pythons(pid)} == {ORDINARY}


def test_an_actuator_that_its_watchdog_starts_again_runs_as_the_first_did(rig: Rig) -> None:
    watchdog = rig.actuator()
    first = watchdog.child
    assert first
    os.kill(first, signal.SIGKILL)
    until(lambda: watchdog.child not in (None, first), "another")
    again = watchdog.child or 0
    until(lambda: pythons(again).count(FEEDS) >= LEAST_INBOXES, "its inboxes")
    assert rank(again) == ACTUATOR
    assert set(zenohs(again)) == {FEEDS}
