"""Every way a process can fail, of each and of two at once, in every state: `python -m faults.matrix`.

In each trial the operator goes on as before, and whatever of the robot was frozen comes back.
"""

import argparse
import itertools
import os
import random
import resource
import signal
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from zteleop import config
from zteleop.chaos.bench import Bench, Subject, endpoint
from zteleop.chaos.people import press
from zteleop.chaos.process import actuator_of
from zteleop.errors import ZteleopError

DEAD, FROZEN = 0.05, 0.45
"""s until rest after a process is gone, or stands still"""
AWAY = 2.3
"""s that a frozen process stands still: long enough that whoever drives must begin anew"""
QUIET = 0.6
PATIENCE = 5.0
SLOW_WRITE_MS = 20
LATER = {"writing": 0.02, "fault": 0.15}
"""s that the chip itself holds up whoever wants to write neutral"""
SETTINGS = "[drive.deadlines]\noperator = 0.6\n"
OPERATE = """
import itertools, sys
from zteleop import BusSettings, Node, Twist
bus = BusSettings(mode="client", connect=[sys.argv[1]], multicast=False)
with Node("operator", sys.argv[2], bus) as node:
    motors = node.publisher("cmd_vel", Twist, source="keyboard")
    acts, said = int(sys.argv[3]), itertools.count()
    @node.every(0.02)
    def drive():
        (motors.publish if next(said) < acts else motors.repeat)(Twist.planar(0.7, 0.5))
    node.spin()
"""
ALWAYS, FOR_A_WHILE = 10**9, 20


def starve(pid: int) -> None:
    """Grant a process no page more than it has."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[0])
    resource.prlimit(pid, resource.RLIMIT_AS, (pages * resource.getpagesize(), resource.RLIM_INFINITY))


SIGNALS = {
    "killed": signal.SIGKILL,
    "crashes": signal.SIGSEGV,
    "ends": signal.SIGTERM,
    "frozen": signal.SIGSTOP,
}
FAILURES = (*SIGNALS, "out of memory", "error in its loop", "hangs at its end")
WHO = ("operator", "actuator", "watchdog")
PARTIES = [*((one,) for one in WHO), *itertools.combinations(WHO, 2)]
STATES = ("starting", "idle", "driving", "writing", "link lost", "operator idle", "stopped", "fault")


class Trial(NamedTuple):
    failure: str
    party: tuple[str, ...]
    state: str

    @property
    def name(self) -> str:
        return f"{self.state}: {' and '.join(self.party)} {self.failure}"

    @property
    def bound(self) -> float | None:
        """s until rest, where it moves; None where whoever has no memory left may go on."""
        if self.failure == "out of memory":
            return None
        return FROZEN if self.failure == "frozen" else DEAD + LATER.get(self.state, 0.0)


def trials() -> Iterator[Trial]:
    """Yield all that can be: with actuator and watchdog killed at once nobody is left to write."""
    for trial in itertools.starmap(Trial, itertools.product(FAILURES, PARTIES, STATES)):
        nobody = set(trial.party) == {"actuator", "watchdog"} and trial.failure in ("killed", "crashes")
        no_operator = "operator" in trial.party and trial.state in ("starting", "idle")
        if not nobody and not no_operator:
            yield trial


class Stage:
    """A robot brought into a state, and what is done to it there."""

    def __init__(self, bench: Bench, trial: Trial) -> None:
        self.bench, self.trial = bench, trial
        self.pids: dict[str, int] = {}

    def prepare(self) -> None:
        bench, state = self.bench, self.trial.state
        self._until(lambda: actuator_of(bench.watchdog.pid), "the actuator starts")
        if state not in ("starting", "idle"):
            self._drive(FOR_A_WHILE if state == "operator idle" else ALWAYS)
        if state == "idle":
            heard = bench.node.membership.heard()
            self._until(lambda: heard.listen() or heard.ready, "the robot is ready")
        if state == "link lost":
            bench.operator.signal(signal.SIGSTOP)
        if state == "stopped":
            press(bench)
        if state in ("link lost", "operator idle", "stopped"):
            self._until(lambda: bench.eye.at_rest, f"it is {state}")
        self.pids = {"actuator": bench.actuator, "watchdog": bench.watchdog.pid}
        if bench.operator:
            self.pids["operator"] = bench.operator.pid

    def _drive(self, acts: int) -> None:
        bench = self.bench
        command = [sys.executable, "-c", OPERATE, endpoint(bench.place.address), bench.place.robot, str(acts)]
        bench.operator = bench.run("operator", command)
        self._until(lambda: not bench.eye.at_rest, "it drives")

    def strike(self) -> None:
        self.bench.place.order.write_text("hang" if "end" in self.trial.failure else "raise MainThread")
        with ExitStack() as stack:
            if self.trial.state in ("fault", "writing"):
                faults = stack.enter_context(self.bench.faults())
                if self.trial.state == "fault":
                    faults.nack(2**32 - 1)
                    stack.callback(faults.clear)
                    time.sleep(0.3)
                else:
                    faults.hang(1, SLOW_WRITE_MS)
                    time.sleep(0.005)
            for who in self.trial.party:
                self._fail(self.pids[who])

    def _fail(self, pid: int) -> None:
        failure = self.trial.failure
        with suppress(ProcessLookupError):
            if failure == "out of memory":
                starve(pid)
            elif failure in SIGNALS:
                os.kill(pid, SIGNALS[failure])
            else:
                os.kill(pid, signal.SIGUSR1)
                if "end" in failure:
                    os.kill(pid, signal.SIGTERM)

    def come_back(self) -> None:
        """Let the robot's own go on; a program that goes on acts anew, and may drive."""
        for who in {"actuator", "watchdog"}.intersection(self.trial.party):
            with suppress(ProcessLookupError):
                os.kill(self.pids[who], signal.SIGCONT)

    def _until(self, condition: Callable[[], object], what: str) -> None:
        if self.bench.until(condition, PATIENCE * 2) is None:
            raise ZteleopError(f"not before the strike: {what}; {self.bench.watchdog.words}")


def attempt(subject: Subject, trial: Trial) -> tuple[float | None, str]:
    """Return the seconds until rest, and what went wrong, if anything."""
    with Bench(subject) as bench:
        stage = Stage(bench, trial)
        stage.prepare()
        time.sleep(random.uniform(0.0, 0.05))
        both_frozen = trial.failure == "frozen" and set(trial.party) == {"actuator", "watchdog"}
        stage.strike()
        if both_frozen:
            time.sleep(AWAY)
            stage.come_back()
        began = time.monotonic()
        if trial.bound is None:
            return None, last_resort(bench, stage)
        rested = bench.until(lambda: bench.eye.at_rest, PATIENCE)
        if rested is None:
            return None, "its wheels still turned"
        if trial.failure == "frozen" and set(trial.party) == {"actuator"}:
            return rested - began, ""  # another takes its place, and whoever goes on may drive on
        if trial.failure == "frozen" and not both_frozen:
            broken = moves(bench, AWAY - (rested - began))
            stage.come_back()
            return rested - began, broken or moves(bench, QUIET)
        return rested - began, moves(bench, QUIET)


def moves(bench: Bench, seconds: float) -> str:
    """Watch whether it moves although nobody has begun anew."""
    return "" if bench.until(lambda: not bench.eye.at_rest, seconds) is None else "it moved again"


def last_resort(bench: Bench, stage: Stage) -> str:
    """Whoever has no memory left may go on, as long as the robot still stops when its operator is gone."""
    time.sleep(QUIET)
    if bench.operator:
        bench.operator.signal(signal.SIGKILL)
    rested = bench.until(lambda: bench.eye.at_rest, FROZEN)
    return "its wheels still turned without an operator" if rested is None else ""


def main() -> int:
    """Return 0 when every trial went as it must."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="trials whose name holds this")
    parser.add_argument("--every", type=int, default=1, help="only one trial of so many")
    options = parser.parse_args()
    chosen = [trial for trial in trials() if options.only in trial.name][:: options.every]
    seconds: dict[str, list[float]] = {failure: [] for failure in FAILURES}
    wrong = 0
    with TemporaryDirectory() as folder:
        file = Path(folder) / "config.toml"
        file.write_text(SETTINGS)
        subject = Subject(config.load(file), ("--driver", "simulated", "--config", str(file)))
        for trial in chosen:
            try:
                took, broken = attempt(subject, trial)
            except ZteleopError as error:
                took, broken = None, str(error)
            if took is not None and trial.state in ("driving", "writing"):
                seconds[trial.failure].append(took)
            if took is not None and trial.bound and took > trial.bound:
                broken = broken or f"it took {1000 * took:.1f} ms until rest, bound {1000 * trial.bound:.0f}"
            wrong += bool(broken)
            if broken:
                print(f"BROKEN  {trial.name}: {broken}", flush=True)
    for failure, took in seconds.items():
        if took:
            figures = f"median {1000 * statistics.median(took):6.1f} ms, worst {1000 * max(took):6.1f} ms"
            print(f"{failure:18} {len(took):3} while driving, {figures}")
    print(f"{len(chosen) - wrong} of {len(chosen)} trials as they must be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
