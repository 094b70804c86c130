"""The meter reads what the kernel tells of who waited; here it tells what a test wants."""

import os
from pathlib import Path

import pytest

from zteleop.chaos import waiting
from zteleop.chaos.waiting import Meter, await_quiet, judge

TICKS_A_SECOND = os.sysconf("SC_CLK_TCK")


class Kernel:
    """A /proc of threads that waited, and of cores that were stolen from."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.steal(0, 0)

    def wait(self, pid: int, tid: int, seconds: float) -> None:
        file = self.folder / f"{pid}/task/{tid}/schedstat"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"111 {round(seconds * 1e9)} 3\n")

    def end(self, pid: int) -> None:
        (self.folder / str(pid)).rename(self.folder / f"gone-{pid}")

    def steal(self, *seconds: float) -> None:
        cores = [
            f"cpu{core} 1 2 3 4 5 6 7 {round(taken * TICKS_A_SECOND)} 0 0"
            for core, taken in enumerate(seconds)
        ]
        self.folder.joinpath("stat").write_text("\n".join(["cpu 1 2 3 4 5 6 7 999999 0 0", *cores, "intr 5"]))


@pytest.fixture
def kernel(tmp_path: Path) -> Kernel:
    return Kernel(tmp_path)


def test_of_each_process_the_longest_waiting_thread_counts(kernel: Kernel) -> None:
    for pid, tid in ((1, 1), (1, 2), (5, 5)):
        kernel.wait(pid, tid, 10.0)
    meter = Meter(lambda: [1, 5], kernel.folder)
    assert meter.waited == 0
    kernel.wait(1, 1, 10.2)
    kernel.wait(1, 2, 10.5)
    kernel.wait(5, 5, 10.1)
    assert meter.waited == pytest.approx(0.6)
    assert meter.longest == pytest.approx(0.5)


def test_who_is_not_on_the_path_excuses_nobody(kernel: Kernel) -> None:
    kernel.wait(1, 1, 10.0)
    kernel.wait(7, 7, 10.0)
    meter = Meter(lambda: [1], kernel.folder)
    kernel.wait(7, 7, 99.0)
    assert meter.waited == 0


def test_a_process_that_starts_meanwhile_counts_from_its_start(kernel: Kernel) -> None:
    path = [1]
    kernel.wait(1, 1, 10.0)
    meter = Meter(lambda: path, kernel.folder)
    path.append(6)
    kernel.wait(6, 6, 0.3)
    assert meter.waited == pytest.approx(0.3)


def test_what_was_seen_of_a_process_that_ended_counts(kernel: Kernel) -> None:
    kernel.wait(1, 1, 10.0)
    meter = Meter(lambda: [1], kernel.folder)
    kernel.wait(1, 1, 10.4)
    meter.look()
    kernel.end(1)
    assert meter.waited == pytest.approx(0.4)


def test_a_core_that_the_host_took_counts_once(kernel: Kernel) -> None:
    kernel.steal(5.0, 5.0)
    meter = Meter(lambda: [], kernel.folder)
    kernel.steal(5.5, 5.2)
    assert meter.waited == pytest.approx(0.5)


def test_a_kernel_that_counts_nothing_excuses_nothing(tmp_path: Path) -> None:
    assert Meter(lambda: [1], tmp_path).waited == 0


@pytest.mark.parametrize(
    ("seconds", "waited", "verdict"),
    [
        (0.1, 0.0, "in time"),
        (0.1, 9.0, "in time"),
        (0.15, 0.0, "late"),
        (0.15, 0.04, "late"),
        (0.15, 0.06, "not judged"),
        (0.99, 0.95, "not judged"),
        (1.0, 0.95, "late"),
    ],
)
def test_lateness_that_others_explain_counts_neither_way(seconds: float, waited: float, verdict: str) -> None:
    assert judge(seconds, 0.1, waited) == verdict


def test_a_quiet_machine_is_not_waited_for_and_a_busy_one_not_for_ever(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = Clock(tmp_path)
    monkeypatch.setattr(waiting, "time", clock)
    assert await_quiet(3.0, tmp_path)
    assert clock.now <= 0.5
    clock.busy_until = 2.0
    assert await_quiet(3.0, tmp_path)
    assert 2.0 <= clock.now <= 3.0
    clock.busy_until = float("inf")
    began = clock.now
    assert not await_quiet(3.0, tmp_path)
    assert clock.now - began == pytest.approx(3.5, abs=0.5)


class Clock:
    """A time in which the machine is busy until a moment."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / "pressure/cpu"
        self.file.parent.mkdir()
        self.now = self.stalled = 0.0
        self.busy_until = 0.0
        self.sleep(0.0)

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.stalled += max(0.0, min(seconds, self.busy_until - self.now))
        self.now += seconds
        self.file.write_text(
            f"some avg10=1.00 avg60=2.00 avg300=3.00 total={round(self.stalled * 1e6)}\n"
            "full avg10=0.00 avg60=0.00 avg300=0.00 total=7\n"
        )
