"""With real processes only where the kernel's part is what matters."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from select import select
from typing import Any

import pytest

from zteleop.control.standing import Standing
from zteleop.machine import child as module
from zteleop.machine import link
from zteleop.machine.backoff import FIRST_PAUSE, LONGEST_PAUSE, STEADY
from zteleop.machine.child import DIES_WITHIN, Child
from zteleop.machine.link import Report
from zteleop.processes.actuator import orders

STANDING = Standing(1, 100.5, 100.75, 101.0, 2, 7, 100.9, 101.25)
SLEEPER = [sys.executable, "-S", "-c", "import time; time.sleep(60)"]
ECHO = [sys.executable, "-S", "-c", "import sys; open(sys.argv[1], 'wb').write(sys.stdin.buffer.read())"]


class Process:
    """A process that ends `takes` seconds after it was told to, or never; remembers what it was told."""

    def __init__(self, command: list[str], takes: float | None, options: dict[str, Any]) -> None:
        self.command, self.options, self.takes = command, options, takes
        self.told: list[str] = []
        self.waits: list[float] = []
        self.returncode: int | None = None
        self.stdin = Stdin()

    def poll(self) -> int | None:
        return self.returncode

    def terminate(self) -> None:
        self.told.append("terminate")

    def kill(self) -> None:
        self.told.append("kill")

    def wait(self, patience: float) -> int:
        self.waits.append(patience)
        if self.takes is None or self.takes > sum(self.waits):
            raise subprocess.TimeoutExpired("x", patience)
        self.returncode = -9 if "kill" in self.told else 0
        return self.returncode


class Stdin:
    broken = False

    def __init__(self) -> None:
        self.data, self.closed = b"", False

    def write(self, data: bytes) -> None:
        if self.broken:
            raise BrokenPipeError
        self.data += data

    def __enter__(self) -> "Stdin":
        return self

    def __exit__(self, *exc: object) -> None:
        self.closed = True


class Nursery:
    """Starts processes that are none."""

    def __init__(self) -> None:
        self.takes: float | None = 0.0
        self.born: list[Process] = []

    def popen(self, command: list[str], **options: Any) -> Process:
        self.born.append(Process(command, self.takes, options))
        return self.born[-1]


@pytest.fixture
def nursery(monkeypatch: pytest.MonkeyPatch) -> Nursery:
    nursery = Nursery()
    monkeypatch.setattr(module.subprocess, "Popen", nursery.popen)
    return nursery


@pytest.fixture
def child(nursery: Nursery) -> Iterator[Child]:
    child = Child(["zteleop", "actuator"], b"settings", [33])
    child.start(100.0)
    yield child
    if child.link:
        child.link.close()


def test_it_is_started_with_its_link_its_files_and_its_settings(child: Child, nursery: Nursery) -> None:
    (process,) = nursery.born
    *command, number = process.command
    assert command == ["zteleop", "actuator"]
    assert process.options["pass_fds"][0] == int(number)
    assert process.options["pass_fds"][-1] == 33
    assert (process.stdin.data, process.stdin.closed) == (b"settings\nnull", True)
    assert (child.starts, child.ready, child.gone) == (1, False, False)


def test_one_in_anothers_place_is_told_where_that_one_stood(nursery: Nursery) -> None:
    child = Child(["zteleop"], b'{"robot": "bench"}')
    child.start(100.0, STANDING)
    settings, standing = orders(nursery.born[0].stdin.data)
    assert (settings.robot, standing) == ("bench", STANDING)
    child.end(0.0)


def test_one_that_dies_before_it_reads_its_settings_is_no_error(
    nursery: Nursery, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Stdin, "broken", True)
    child = Child(["zteleop"], b"settings")
    child.start(100.0)
    with pytest.raises(EOFError):
        child.hear(101.0)
    child.end(0.0)


@pytest.fixture
def actuators(nursery: Nursery, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Any]]:
    """Return the other ends of the links, of one child after the other."""
    ends: list[Any] = []
    real = link.pair

    def pair() -> Any:
        dog, theirs = real()
        ends.append(link.adopt(theirs.dup().detach()))
        return dog, theirs

    monkeypatch.setattr(link, "pair", pair)
    yield ends
    for end in ends:
        end.close()


def test_its_silence_counts_from_the_start_until_it_reports(actuators: list[Any]) -> None:
    child = Child(["zteleop"], b"")
    child.start(100.0)
    child.hear(101.0)
    assert (child.ready, child.silence(101.5)) == (False, 1.5)
    for stepped in (101.0, 101.6):
        actuators[0].report(Report(stepped, STANDING))
    child.hear(101.0)
    assert (child.ready, child.newest) == (True, Report(101.6, STANDING))
    child.hear(101.0)
    assert child.silence(102.0) == pytest.approx(0.4)
    child.end(0.0)
    child.start(103.0)
    assert (child.ready, child.starts) == (False, 2)
    child.end(0.0)


def test_it_is_stopped_since_it_first_said_so(actuators: list[Any]) -> None:
    child = Child(["zteleop"], b"")
    child.start(100.0)
    since = []
    for now, stopped in ((101.0, False), (102.0, True), (103.0, True), (104.0, False), (105.0, True)):
        actuators[0].report(Report(now, STANDING, stopped))
        child.hear(now)
        since.append(child.stopped_since)
    assert since == [None, 102.0, 102.0, None, 105.0]
    child.end(0.0)
    child.start(106.0)
    assert child.stopped_since is None
    child.end(0.0)


def test_the_pause_doubles_to_five_seconds(child: Child) -> None:
    pauses = [child.pause(101.0) for _ in range(9)]
    assert pauses == [FIRST_PAUSE * 2**n for n in range(6)] + [LONGEST_PAUSE] * 3


def test_one_that_lived_for_ten_seconds_begins_anew(child: Child) -> None:
    for _ in range(5):
        child.pause(101.0)
    assert child.pause(100.0 + STEADY) > FIRST_PAUSE
    assert child.pause(100.0 + STEADY + 0.01) == FIRST_PAUSE
    child.end(0.0)
    child.start(200.0)
    assert child.pause(200.1) == 2 * FIRST_PAUSE


def test_one_that_ends_in_time_is_not_killed(child: Child, nursery: Nursery) -> None:
    nursery.born[0].takes = 0.2
    child.ask_to_end()
    assert child.end(0.25) == 0
    assert nursery.born[0].told == ["terminate"]
    assert child.gone
    assert child.link is None


def test_one_that_does_not_is_killed_and_the_wait_is_bounded(child: Child, nursery: Nursery) -> None:
    nursery.born[0].takes = None
    assert child.end(0.25) is None
    assert nursery.born[0].told[0] == "kill"
    assert nursery.born[0].waits == [0.25, DIES_WITHIN]
    assert not child.gone
    assert child.link is None, "its reports count no longer"
    nursery.born[0].returncode = -9
    assert child.gone


def test_it_may_be_ended_before_it_began_and_twice() -> None:
    child = Child(["zteleop"], b"")
    child.ask_to_end()
    assert child.end(1.0) is None
    assert child.gone


def test_a_real_one_gets_its_settings_and_ends_with_its_code(tmp_path: Any) -> None:
    settings = json.dumps({"x": "y" * 5000}).encode()
    child = Child([*ECHO, str(tmp_path / "said")], settings)
    child.start(100.0)
    assert child.end(5.0) == 0
    assert (tmp_path / "said").read_bytes() == settings + b"\nnull"


def test_the_link_ends_with_the_child_although_a_sibling_lives_on() -> None:
    """Any process that held the other end as well would keep the child's death from the watchdog."""
    one, two = Child(SLEEPER, b""), Child(SLEEPER, b"")
    one.start(100.0)
    two.start(100.0)
    with subprocess.Popen(SLEEPER, close_fds=False) as stranger:
        try:
            one._process.kill()
            began = time.monotonic()
            assert one.link
            assert select([one.link.fileno()], [], [], 2.0)[0], "the end of the link never came"
            with pytest.raises(EOFError):
                one.hear(101.0)
            assert time.monotonic() - began < 1.0
            two.hear(101.0)
            assert (two.gone, stranger.poll()) == (False, None)
        finally:
            stranger.kill()
            for child in (one, two):
                child.end(0.0)
    assert one.end(0.0) == two.end(0.0) == -9


def test_a_frozen_one_is_killed() -> None:
    child = Child(SLEEPER, b"")
    child.start(100.0)
    child._process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, child._process.pid, os.WSTOPPED | os.WNOWAIT)
    child.ask_to_end()
    child.end(0.0)
    assert child.end(2.0) == -signal.SIGKILL


@pytest.mark.parametrize("stepped", [float("nan"), float("inf"), 1e308, 1000.0])
def test_a_step_at_no_time_or_yet_to_come_is_silence_since_the_start(child: Child, stepped: float) -> None:
    child.newest, child.started = Report(stepped, STANDING), 900.0
    assert child.silence(999.0) == 99.0  # a figure that can be told: the bus takes no other


def test_a_report_wakes_nobody_and_the_end_does(tmp_path: Any) -> None:
    child = Child([*SLEEPER], b"{}")
    child.start(time.monotonic())
    try:
        assert not select([child], [], [], 0)[0]
        os.kill(child._process.pid, signal.SIGKILL)
        assert select([child], [], [], 10)[0]
        pipe = child.fileno()
    finally:
        child.end(1.0)
    assert child.link is None
    with pytest.raises(OSError, match="Bad file"):
        os.fstat(pipe)
