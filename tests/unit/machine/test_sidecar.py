import subprocess
from itertools import pairwise
from typing import Any

import pytest

from zteleop.machine import sidecar as module
from zteleop.machine.sidecar import DELAY, ENDS_WITHIN, LAST_WORD, STARTS, STEADY, Recorder


class Ear:
    def __init__(self, fails: bool) -> None:
        self.fails, self.said, self.closed = fails, b"", False

    def fileno(self) -> int:
        return 99

    def write(self, data: bytes) -> None:
        if self.fails:
            raise BrokenPipeError(32, "Broken pipe")
        self.said += data

    def close(self) -> None:
        self.closed = True

    def __enter__(self) -> "Ear":
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()


class Process:
    fails = False
    hangs = False

    def __init__(self, command: list[str], options: dict[str, Any]) -> None:
        self.command, self.options, self.stdin = command, options, Ear(self.fails)
        self.returncode: int | None = None
        self.waits: list[float] = []

    def poll(self) -> int | None:
        return self.returncode

    def wait(self, patience: float) -> int:
        self.waits.append(patience)
        if self.hangs:
            raise subprocess.TimeoutExpired("x", patience)
        return 0


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Process]:
    started: list[Process] = []

    def start(command: list[str], **options: Any) -> Process:
        started.append(Process(command, options))
        return started[-1]

    monkeypatch.setattr(subprocess, "Popen", start)
    monkeypatch.setattr(module.os, "set_blocking", lambda file, blocking: None)
    return started


@pytest.fixture
def warnings() -> list[str]:
    return []


@pytest.fixture
def recorder(started: list[Process], warnings: list[str]) -> Recorder:
    return Recorder(["black", "box"], b"settings", warnings.append)


def test_it_starts_after_the_robot_has_begun(recorder: Recorder, started: list[Process]) -> None:
    recorder.tend(0.0)
    recorder.tend(DELAY - 0.1)
    assert not started
    recorder.tend(DELAY)
    recorder.tend(DELAY + 100)
    (process,) = started
    assert (process.command, process.stdin.said) == (["black", "box"], b"settings\n")
    assert process.options["start_new_session"]
    assert not process.stdin.closed


def test_one_that_ends_is_started_again_later_and_later_and_a_few_times_only(
    recorder: Recorder, started: list[Process], warnings: list[str]
) -> None:
    starts, now = [], 0.0
    while now < 1000.0:
        before = len(started)
        recorder.tend(now)
        if len(started) > before:
            starts.append(now)
            started[-1].returncode = 1
        now += 0.25
    assert len(starts) == STARTS
    pauses = [late - soon for soon, late in pairwise(starts)]
    assert pauses == sorted(pauses)
    assert all(process.stdin.closed for process in started[:-1])
    assert warnings == [
        *(f"the black box is gone: it ended; another starts in {2**n} s" for n in range(1, STARTS)),
        f"the black box has ended {STARTS} times in a row, and is not started again",
    ]


def test_one_that_ends_now_and_then_is_started_each_time(
    recorder: Recorder, started: list[Process], warnings: list[str]
) -> None:
    for number in range(2 * STARTS):
        now = number * 2 * STEADY
        recorder.tend(now)
        recorder.tend(now + DELAY)
        assert len(started) == number + 1
        started[-1].returncode = -9
    told = "the black box is gone: it ended, by SIGKILL; another starts in 1 s"
    assert warnings == (2 * STARTS - 1) * [told]


def test_what_cannot_be_started_is_said_and_ends_nothing(
    recorder: Recorder, warnings: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    recorder.tend(0.0)
    recorder.tend(DELAY)
    assert warnings == ["there is no black box: Resource temporarily unavailable"]
    recorder.end()


def test_it_is_told_of_an_end_in_good_order(recorder: Recorder, started: list[Process]) -> None:
    recorder.tend(0.0)
    recorder.tend(DELAY)
    recorder.end()
    assert started[0].stdin.said.endswith(LAST_WORD)
    assert started[0].stdin.closed
    assert started[0].waits == [ENDS_WITHIN]


@pytest.mark.parametrize("defect", ["fails", "hangs"])
def test_one_that_does_not_listen_holds_up_nobody(
    recorder: Recorder, started: list[Process], defect: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorder.tend(0.0)
    recorder.tend(DELAY)
    monkeypatch.setattr(started[0], defect, True)
    started[0].stdin.fails = defect == "fails"
    recorder.end()
    assert started[0].waits == [ENDS_WITHIN]


def test_one_that_never_started_needs_no_farewell(recorder: Recorder) -> None:
    recorder.end()
