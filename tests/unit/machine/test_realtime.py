import errno
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Any

import pytest

from zteleop.errors import DeviceError
from zteleop.machine import realtime
from zteleop.machine.realtime import FEEDERS, LOCKED, PRIORITY, SURVIVAL, Linux, ask_for, lent

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="asks Linux")

AS_THIS_USER = """
import ctypes, json, os, resource, threading
from zteleop.machine.realtime import follow, lent, ask_for
{prepare}
def rank():
    return os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK, os.sched_getparam(0).sched_priority
def started(first=rank):
    ranks = []
    def run():
        first()
        ranks.append(rank())
    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    return ranks[0]
with lent(5):
    lent_to = started()
after = rank()
score = int(open("/proc/self/oom_score_adj").read())
refused = ask_for(5, -500)
heap = bytearray({allocate})
process = os.fork()
if not process:
    os._exit(os.sched_getscheduler(0))
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
print(json.dumps({{
    "refused": refused,
    "first": os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO,
    "lent": [lent_to, after],
    "threads": [started(), started(follow)],
    "process": os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]),
    "locked": int(status["VmLck"].split()[0]) > 0,
    "limit": resource.getrlimit(resource.RLIMIT_MEMLOCK),
    "scores": [score, int(open("/proc/self/oom_score_adj").read())],
}}))
"""

MEBIBYTE = 1 << 20
ORDINARY = """
hard = resource.getrlimit(resource.RLIMIT_MEMLOCK)[1]
limit = 256 << 20 if hard == resource.RLIM_INFINITY else min(256 << 20, hard)
resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
resource.setrlimit(resource.RLIMIT_MEMLOCK, (limit, limit))
open("/proc/self/oom_score_adj", "w").write("0")
if os.geteuid() == 0:
    os.setuid(65534)
"""


class Kernel(Linux):
    """Grants what is asked, but for what it is told to refuse; runs this thread in no other way."""

    def __init__(self, oom_score: Path, refuses: str = "") -> None:
        self.oom_score, self.refuses = oom_score, refuses
        self.asked: list[Any] = []

    def run_first(self, priority: int) -> None:
        self.asked.append(priority)
        self._answer("run_first")

    def rank(self) -> tuple[int, int]:
        return os.SCHED_BATCH, 0

    def run_as(self, policy: int, priority: int) -> None:
        self.asked.append((policy, priority))
        self._answer("run_as")

    def lock_memory(self) -> None:
        self.asked.append("memory")
        self._answer("lock_memory")

    def _answer(self, what: str) -> None:
        if what == self.refuses:
            raise PermissionError(errno.EPERM, "no")


@pytest.fixture
def score(tmp_path: Path) -> Path:
    file = tmp_path / "oom_score_adj"
    file.write_text("0\n")
    return file


def test_what_is_granted_is_not_spoken_of(score: Path) -> None:
    kernel = Kernel(score)
    assert ask_for(20, -900, kernel) == []
    assert kernel.asked == [20, "memory"]
    assert score.read_text() == "-900"


@pytest.mark.parametrize(("refused", "phrase"), [("run_first", PRIORITY), ("lock_memory", LOCKED)])
def test_one_refusal_is_one_phrase_and_the_rest_is_still_taken(
    score: Path, refused: str, phrase: str
) -> None:
    kernel = Kernel(score, refused)
    assert ask_for(20, -900, kernel) == [phrase]
    assert kernel.asked == [20, "memory"]
    assert score.read_text() == "-900"


@pytest.mark.parametrize(
    ("found", "left"),
    [("-100", "-100"), ("-1000", "-900"), ("200", "-900")],
    ids=["never below systemd's choice", "above a parent's", "a desktop's is lowered"],
)
def test_the_score_left(score: Path, found: str, left: str) -> None:
    score.write_text(f"{found}\n")
    assert ask_for(20, -900, Kernel(score)) == []
    assert score.read_text() == left


@pytest.mark.parametrize("spoil", [Path.unlink, lambda file: file.write_text("none")])
def test_a_score_that_cannot_be_told_is_refused(score: Path, spoil: Callable[[Path], object]) -> None:
    spoil(score)
    assert ask_for(20, -900, Kernel(score)) == [SURVIVAL]


def test_elsewhere_than_on_linux_all_are_refused_quietly(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(realtime.sys, "platform", "darwin")
    assert ask_for(20, -900) == [PRIORITY, LOCKED, SURVIVAL]
    assert capfd.readouterr() == ("", "")


@linux_only
def test_threads_are_lent_a_priority_below_the_loops_and_nothing_that_starts_later_is(score: Path) -> None:
    kernel = Kernel(score)
    with suppress(DeviceError), lent(20, kernel):
        assert kernel.asked == [(os.SCHED_RR, 20), (os.SCHED_RR, FEEDERS)]
        raise DeviceError("this robot has an actuator already")
    assert kernel.asked[2:] == [(os.SCHED_BATCH, 0)]


@linux_only
def test_who_may_not_run_first_lends_nothing_lest_what_feeds_a_loop_run_before_it(score: Path) -> None:
    kernel = Kernel(score, "run_as")
    with lent(20, kernel):
        assert kernel.asked == [(os.SCHED_RR, 20)]


def test_elsewhere_than_on_linux_threads_are_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(realtime.sys, "platform", "darwin")
    monkeypatch.setattr(Linux, "run_as", pytest.fail)
    with lent(20):
        pass


class Limits:
    """A kernel's limit on locked memory; who may not raise it may lower it."""

    INFINITY = resource.RLIM_INFINITY

    def __init__(self, monkeypatch: pytest.MonkeyPatch, limit: tuple[int, int], privileged: bool) -> None:
        self.limit, self.privileged = limit, privileged
        self.locked_under: list[int] = []
        monkeypatch.setattr(resource, "getrlimit", lambda _: self.limit)
        monkeypatch.setattr(resource, "setrlimit", self.set)
        monkeypatch.setattr(realtime, "_mlockall", self.lock)

    def set(self, _: int, limit: tuple[int, int]) -> None:
        if limit[1] == self.INFINITY and self.limit[1] != self.INFINITY:
            raise ValueError("not allowed to raise maximum limit")
        self.limit = limit

    def lock(self, flags: int) -> None:
        self.locked_under.append(self.limit[0])
        if self.limit[0] == 0 and not self.privileged:
            raise PermissionError(errno.EPERM, "mlockall")


@linux_only
def test_memory_is_locked_where_the_limit_can_be_lifted(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = Limits(monkeypatch, (MEBIBYTE, Limits.INFINITY), privileged=False)
    Linux().lock_memory()
    assert limits.locked_under == [Limits.INFINITY]


@linux_only
@pytest.mark.parametrize("privileged", [False, True])
def test_under_a_finite_limit_only_the_privileged_lock(
    monkeypatch: pytest.MonkeyPatch, privileged: bool
) -> None:
    before = (MEBIBYTE, MEBIBYTE)
    limits = Limits(monkeypatch, before, privileged)
    with nullcontext() if privileged else pytest.raises(PermissionError):
        Linux().lock_memory()
    assert limits.locked_under == [0]
    assert limits.limit == ((0, MEBIBYTE) if privileged else before)


def ask(prepare: str, allocate: int) -> dict[str, Any]:
    program = AS_THIS_USER.format(prepare=prepare, allocate=allocate)
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=30)
    assert (run.returncode, run.stderr) == (0, "")
    told: dict[str, Any] = json.loads(run.stdout)
    return told


@linux_only
def test_what_is_said_is_what_the_kernel_did_and_threads_run_first_only_when_they_ask() -> None:
    told = ask("", allocate=50 * MEBIBYTE)
    refused = told["refused"]
    assert told["first"] == (PRIORITY not in refused)
    assert told["locked"] == (LOCKED not in refused)
    before, after = told["scores"]
    assert after == (before if SURVIVAL in refused or before in range(-500, 0) else -500)
    ordinary, first = [os.SCHED_OTHER, 0], told["first"]
    behind, feeding = ([os.SCHED_FIFO, 1], [os.SCHED_RR, FEEDERS]) if first else (ordinary, ordinary)
    assert told["lent"] == [feeding, ordinary]
    assert told["threads"] == [ordinary, behind]
    assert told["process"] == os.SCHED_OTHER


@linux_only
def test_an_ordinary_user_is_refused_and_can_allocate_more_than_may_be_locked() -> None:
    told = ask(ORDINARY, allocate=300 * MEBIBYTE)
    assert told["refused"] == [PRIORITY, LOCKED, SURVIVAL]
    assert not told["first"]
    assert [*told["lent"], *told["threads"]] == 4 * [[os.SCHED_OTHER, 0]]
    assert not told["locked"]
    assert told["limit"][0] == told["limit"][1] > 0


def test_trying_out_takes_nothing_for_this_process() -> None:
    before = realtime.Linux().rank()
    assert set(realtime.try_out(1, 0)) <= {realtime.PRIORITY, realtime.LOCKED, realtime.SURVIVAL}
    assert realtime.Linux().rank() == before
