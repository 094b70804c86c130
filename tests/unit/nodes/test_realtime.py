import errno
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest

from zteleop.nodes import realtime
from zteleop.nodes.realtime import LOCKED, PRIORITY, SURVIVAL, Linux, take

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="asks Linux")

AS_THIS_USER = """
import ctypes, json, os, resource, threading
from zteleop.nodes.realtime import follow, take
{prepare}
score = int(open("/proc/self/oom_score_adj").read())
refused = take(5, -500)
heap = bytearray({allocate})
children = []
def child():
    children.append(os.sched_getscheduler(0))
    follow()
    children.append(os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK)
    children.append(os.sched_getparam(0).sched_priority)
thread = threading.Thread(target=child)
thread.start()
thread.join()
status = dict(line.split(":", 1) for line in open("/proc/self/status"))
print(json.dumps({{
    "refused": refused,
    "first": os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO,
    "child": children,
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
    """Grants what is asked, but for what it is told to refuse."""

    def __init__(self, oom_score: Path, refuses: str = "") -> None:
        self.oom_score, self.refuses = oom_score, refuses
        self.asked: list[Any] = []

    def run_first(self, priority: int) -> None:
        self.asked.append(priority)
        self._answer("run_first")

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
    assert take(20, -900, kernel) == []
    assert kernel.asked == [20, "memory"]
    assert score.read_text() == "-900"


@pytest.mark.parametrize(("refused", "phrase"), [("run_first", PRIORITY), ("lock_memory", LOCKED)])
def test_one_refusal_is_one_phrase_and_the_rest_is_still_taken(
    score: Path, refused: str, phrase: str
) -> None:
    kernel = Kernel(score, refused)
    assert take(20, -900, kernel) == [phrase]
    assert kernel.asked == [20, "memory"]
    assert score.read_text() == "-900"


@pytest.mark.parametrize(
    ("found", "left"),
    [("-100", "-100"), ("-1000", "-900"), ("200", "-900")],
    ids=["never below systemd's choice", "above a parent's", "a desktop's is lowered"],
)
def test_the_score_left(score: Path, found: str, left: str) -> None:
    score.write_text(f"{found}\n")
    assert take(20, -900, Kernel(score)) == []
    assert score.read_text() == left


@pytest.mark.parametrize("spoil", [Path.unlink, lambda file: file.write_text("none")])
def test_a_score_that_cannot_be_told_is_refused(score: Path, spoil: Callable[[Path], object]) -> None:
    spoil(score)
    assert take(20, -900, Kernel(score)) == [SURVIVAL]


def test_elsewhere_than_on_linux_all_are_refused_quietly(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(realtime.sys, "platform", "darwin")
    assert take(20, -900) == [PRIORITY, LOCKED, SURVIVAL]
    assert capfd.readouterr() == ("", "")


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
def test_what_is_said_is_what_the_kernel_did_and_threads_follow_only_when_they_ask() -> None:
    told = ask("", allocate=50 * MEBIBYTE)
    refused = told["refused"]
    assert told["first"] == (PRIORITY not in refused)
    assert told["locked"] == (LOCKED not in refused)
    before, after = told["scores"]
    assert after == (before if SURVIVAL in refused or before in range(-500, 0) else -500)
    assert told["child"] == [os.SCHED_OTHER, *((os.SCHED_FIFO, 1) if told["first"] else (os.SCHED_OTHER, 0))]


@linux_only
def test_an_ordinary_user_is_refused_and_can_allocate_more_than_may_be_locked() -> None:
    told = ask(ORDINARY, allocate=300 * MEBIBYTE)
    assert told["refused"] == [PRIORITY, LOCKED, SURVIVAL]
    assert not told["first"]
    assert not told["locked"]
    assert told["limit"][0] == told["limit"][1] > 0
