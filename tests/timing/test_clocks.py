"""No time of day matters; who slept knows it, and what was commanded before does not drive."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from faults.clocks import Clocks
from faults.link.bench import LinkBench
from faults.link.network import Network, obstacle
from verdict import Deadline, excusable

if obstacle():
    pytest.skip(obstacle(), allow_module_level=True)

HOUR = 3600.0
DAYS = {
    "hours-ahead": 7 * HOUR,
    "hours-behind": -7 * HOUR,
    "in-1970": 60.0 - time.time(),
    "in-2037": 11 * 365 * 24 * HOUR,
}
DRIVES = 0.35
"""s of undisturbed driving that show that nothing has changed"""
LONGEST_GAP = 0.15
"""s between two commands on the chip, at 50 Hz"""
WAKES = 0.1
"""s until a robot that slept is at rest"""
SILENCE = 0.45
"""s until a robot rests that hears nothing more, or commands that prove less and less"""


class Sleepers:
    """Both machines, each with clocks of its own."""

    def __init__(self, bench: LinkBench, robot: Clocks, operator: Clocks) -> None:
        self.bench, self.robot, self.operator = bench, robot, operator

    def drive_undisturbed(self) -> None:
        """See that commands go on without a gap, for a while."""
        with excusable(LONGEST_GAP / 2, self.bench.rig):
            since = time.monotonic()
            time.sleep(DRIVES)
            times = [since, *(at for at, _ in self.bench.witness.motions if at > since), time.monotonic()]
            gaps = [later - earlier for earlier, later in pairwise(times)]
            assert max(gaps) < LONGEST_GAP
            assert not [at for at in self.bench.witness.rests if at > since]

    def nothing_went_wrong(self) -> None:
        assert not self.bench.witness.stale
        assert not self.bench.witness.strange
        assert not self.bench.alarms

    def rest_until_begun_anew(self, quiet: float = 0.7) -> None:
        """See that it stays at rest, whatever its operator goes on to say, until it is begun anew."""
        since = time.monotonic()
        self.bench.is_heard_again()
        while time.monotonic() < since + quiet:
            assert self.bench.at_rest
        self.bench.begin_anew()
        self.bench.moves()


@pytest.fixture
def options() -> list[str]:
    return []


@pytest.fixture
def both(tmp_path: Path, options: list[str]) -> Iterator[Sleepers]:
    robot, operator = Clocks(tmp_path, "robot"), Clocks(tmp_path, "operator")
    clocks = {"robot": robot.environment, "operator": operator.environment}
    with Network() as network, LinkBench(network, tmp_path, clocks=clocks, operator=options) as bench:
        time.sleep(0.2)
        yield Sleepers(bench, robot, operator)


@pytest.mark.parametrize("whose", ["operator", "robot"])
def test_the_time_of_day_may_be_any_and_jump_while_it_drives(both: Sleepers, whose: str) -> None:
    clocks: Clocks = getattr(both, whose)
    for day in (*DAYS.values(), 0.4, -0.4, 0.0):
        clocks.set(day=day)
        both.drive_undisturbed()
    both.nothing_went_wrong()


@pytest.mark.parametrize("day", [DAYS["hours-behind"], DAYS["in-1970"]], ids=["hours-behind", "in-1970"])
def test_who_joins_with_a_wrong_time_of_day_drives(tmp_path: Path, day: float) -> None:
    robot, operator = Clocks(tmp_path, "robot"), Clocks(tmp_path, "operator")
    operator.set(day=day)
    clocks = {"robot": robot.environment, "operator": operator.environment}
    with Network() as network, LinkBench(network, tmp_path, clocks=clocks) as bench:
        both = Sleepers(bench, robot, operator)
        both.drive_undisturbed()
        both.nothing_went_wrong()


def test_a_robot_that_slept_rests_until_it_is_begun_anew(both: Sleepers) -> None:
    both.bench.signal_robot(signal.SIGSTOP)
    both.robot.set(start=HOUR)
    deadline = Deadline(both.bench.rig)
    both.bench.signal_robot(signal.SIGCONT)
    deadline.met(lambda: both.bench.at_rest, "neutral after it woke", WAKES)
    both.rest_until_begun_anew()
    both.nothing_went_wrong()


def test_a_sleep_too_short_to_be_seen_in_its_own_steps_changes_nothing(both: Sleepers) -> None:
    both.robot.set(start=0.05)
    both.drive_undisturbed()
    both.nothing_went_wrong()


def sleep(both: Sleepers, seconds: float) -> None:
    """Let the operator's machine sleep: its processes stand still, and its clock knows for how long."""
    deadline, began = Deadline(both.bench.rig), time.monotonic()
    both.bench.operator.signal(signal.SIGSTOP)
    deadline.met(lambda: both.bench.at_rest, "neutral while the operator sleeps", SILENCE)
    time.sleep(max(0.0, began + seconds - time.monotonic()))
    both.operator.set(start=HOUR)
    both.bench.operator.signal(signal.SIGCONT)


@pytest.mark.parametrize("options", [["--standing"]])
def test_an_operator_who_slept_drives_only_after_a_new_act(both: Sleepers) -> None:
    sleep(both, 3.0)
    both.rest_until_begun_anew()
    both.nothing_went_wrong()


def test_a_program_that_slept_executes_nothing_old(both: Sleepers) -> None:
    """Its first command when it wakes is a new act if it has heard the robot by then; else it must let go."""
    sleep(both, 3.0)
    both.bench.is_heard_again()
    both.bench.begin_anew()
    both.bench.moves()
    both.nothing_went_wrong()


def test_clocks_that_are_set_are_seen_by_their_own_machine_alone(tmp_path: Path) -> None:
    clocks = Clocks(tmp_path, "some")
    clocks.set(day=-1.5 * HOUR, start=HOUR + 0.25)
    program = "import time; print(time.time(), time.clock_gettime(time.CLOCK_BOOTTIME), time.monotonic())"
    before = time.time(), time.clock_gettime(time.CLOCK_BOOTTIME), time.monotonic()
    said = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | clocks.environment,
        capture_output=True,
        text=True,
        check=True,
    )
    after = time.time(), time.clock_gettime(time.CLOCK_BOOTTIME), time.monotonic()
    shifted = (-1.5 * HOUR, HOUR + 0.25, 0.0)
    for then, found, now, shift in zip(before, map(float, said.stdout.split()), after, shifted, strict=True):
        assert then <= found - shift <= now
