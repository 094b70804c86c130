"""The watchdog against actuators that do not do as they must, measured at the chip from outside."""

import json
import os
import secrets
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from rig import NEUTRAL, ZTELEOP, Process, Rig, Watch, every, hear, repeating, until

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.drivers.faults import Faults
from zteleop.messages import DriveStatus, Pwm, Stop, WatchdogStatus

FORWARD, DRIVEN = Pwm(390, 400), (390, 400)
STREAM = 0.02
BUSY = 0.1
"""s more than the bound, which a machine that runs other tests may take"""

START = """
import sys
from zteleop.cli import actuator, main
actuator.CHILD = [sys.executable, "-c", sys.argv[1]]
sys.exit(main(["actuator", *sys.argv[2:]]))
"""
ACTUATOR = """
import sys
{defect}
from zteleop.cli import main
sys.exit(main(["actuator", *sys.argv[1:]]))
"""
IGNORES_IDLENESS = """
from zteleop.control.gate import Gate, Refusal
from zteleop.control.mux import Mux
judge = Gate.judge
def lax(*arguments):
    refusal = judge(*arguments)
    return None if refusal is Refusal.OPERATOR_IDLE else refusal
Gate.judge, Mux.idle = lax, lambda self, claim, now: False
"""
IGNORES_SILENCE = """
from zteleop.control.mux import Mux
Mux.silent = lambda self, claim, now: False
"""
HEARS_NO_STOP = """
from zteleop.bus.node import Node
subscription = Node.subscription
def deaf(self, topic, types, handler=None, **options):
    return subscription(self, topic, types, (lambda _: None) if topic == "stop" else handler, **options)
Node.subscription = deaf
"""
MOVES_ALTHOUGH_STOPPED = """
from zteleop.control.drive import Drive
hold = Drive.hold
Drive.hold = lambda self, reason, *words: None if reason == "stop" else hold(self, reason, *words)
"""
MOVES_BY_ITSELF = """
from zteleop.nodes.output import Output
write = Output.write
def creep(self, pulse_us, now):
    if pulse_us != self._neutral_us:
        self.last = pulse_us
    write(self, getattr(self, "last", pulse_us), now)
Output.write = creep
"""


class Bench:
    """A robot, and a node in this process that can drive it and hears what is said of it."""

    def __init__(self, rig: Rig, watchdog: Process) -> None:
        self.rig, self.watchdog = rig, watchdog
        self.last: dict[str, object] = {}
        self.node: Node = rig.node()
        self.statuses = self.node.subscription("drive_status", DriveStatus)
        self.dogs = self.node.subscription("watchdog", WatchdogStatus)
        heard = self.node.heard()

        def ready() -> bool:
            heard.listen()
            return bool(heard.beat and heard.vehicle and heard.vehicle.ready)

        until(ready, "a robot that is ready")
        self.pwm: Publisher[Pwm] = self.node.publisher("pwm", Pwm, source="keyboard")

    @contextmanager
    def driven(self, acts: bool = True) -> Iterator[None]:
        """Drive until the block ends, and then fall silent."""
        self.pwm.act()
        with repeating(lambda: (self.pwm.publish if acts else self.pwm.repeat)(FORWARD), STREAM):
            self.moves()
            yield

    def moves(self) -> None:
        until(lambda: self.rig.ticks == DRIVEN, "the command on the chip")

    def neutral_after(self) -> float:
        return until(lambda: self.rig.ticks == NEUTRAL, "neutral", 7.0)

    def stays_neutral(self, seconds: float = 0.5) -> None:
        for _ in every(0.002, round(seconds * 500)):
            assert self.rig.ticks == NEUTRAL

    @property
    def stop_file(self) -> Path:
        return Path(self.rig.environment["XDG_STATE_HOME"]) / f"zteleop/robots/{self.rig.robot}/stop"

    def is_latched(self, by: str) -> None:
        """A stop by somebody is in the file, and shown to everybody."""
        until(lambda: self.kept, "a stop in the file")
        assert self.kept["by"] == by
        hear(self.statuses, lambda status: status.stop == self.kept["id"], "the stop in drive_status")

    @property
    def kept(self) -> dict[str, object]:
        """The stop in the file; nothing while it is being written."""
        with suppress(FileNotFoundError, ValueError):
            self.last = json.loads(self.stop_file.read_text())
        return self.last

    def press_stop(self) -> None:
        self.node.publisher("stop", Stop).publish(Stop(True, secrets.randbits(53), "the test", ""))


def defective(rig: Rig, defect: str) -> Bench:
    program = ACTUATOR.format(defect=defect)
    bus = ["--no-multicast-scouting", "--listen", rig.endpoint]
    watchdog = rig.program(START, program, "--robot", rig.robot, *bus)
    watchdog.says("obeys")
    return Bench(rig, watchdog)


def wait_idly(bench: Bench) -> float:
    """Hold on without an act; return the seconds of motion since the last."""
    began = clock.now()
    with bench.driven(acts=False):
        bench.neutral_after()
    return clock.now() - began


def fall_silent(bench: Bench) -> float:
    with bench.driven():
        pass
    return bench.neutral_after()


def press_stop(bench: Bench) -> float:
    with bench.driven():
        bench.press_stop()
        return bench.neutral_after()


@pytest.mark.parametrize(
    ("defect", "strike", "bound", "by", "why"),
    [
        (IGNORES_IDLENESS, wait_idly, 5.5, "the watchdog", "although no act on keyboard for 5."),
        (IGNORES_SILENCE, fall_silent, 0.8, "the watchdog", "although keyboard has been silent for 0."),
        (HEARS_NO_STOP, press_stop, 0.6, "the test", "stops the robot: the test"),
    ],
    ids=["ignores its operator's idleness", "ignores silence", "hears no stop"],
)
def test_a_defective_actuator_is_stopped_by_its_watchdog(
    rig: Rig, defect: str, strike: Callable[[Bench], float], bound: float, by: str, why: str
) -> None:
    bench = defective(rig, defect)
    seconds = strike(bench)
    assert seconds <= bound + BUSY
    bench.is_latched(by)
    hear(bench.statuses, lambda status: status.state == "stopped", "stopped")
    bench.watchdog.says(why)
    with repeating(lambda: bench.pwm.publish(FORWARD), STREAM):
        bench.stays_neutral()


def test_an_actuator_that_moves_although_it_is_stopped(rig: Rig) -> None:
    bench = defective(rig, MOVES_ALTHOUGH_STOPPED)
    with bench.driven():
        bench.press_stop()
        assert bench.neutral_after() <= 0.6
        bench.is_latched("the test")
        bench.watchdog.says("its pulses moved although a stop is in force; the chip is kept at rest")
        hear(bench.dogs, lambda dog: dog.restarts == 1 and dog.state == "watching", "another actuator")
        bench.stays_neutral()


def test_an_actuator_that_moves_by_itself_and_heeds_no_stop(rig: Rig) -> None:
    bench = defective(rig, MOVES_BY_ITSELF)
    with bench.driven():
        pass
    bench.watchdog.says("the chip is kept at rest and another starts")
    bench.neutral_after()
    bench.is_latched("the watchdog")
    bench.stays_neutral()


def test_a_chip_belongs_to_an_actuator_whose_watchdog_was_killed_until_it_is_gone_too(rig: Rig) -> None:
    watchdog = rig.actuator()
    actuator = watchdog.child
    assert actuator
    os.kill(actuator, signal.SIGSTOP)  # so that it cannot notice
    try:
        watchdog.signal(signal.SIGKILL)
        watchdog.process.wait()
        second = rig.run("actuator", "--robot", "another", "--no-multicast-scouting")
        assert second.ends() == 1
        assert "already; stop it first" in second.text
    finally:
        os.kill(actuator, signal.SIGKILL)
    rig.actuator()


def test_a_second_actuator_of_the_same_robot_disturbs_nobody(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    with bench.driven(), Watch(rig) as watch:
        second = rig.join("actuator", "--config", os.devnull)
        assert second.ends() == 1
        assert watch.seen == {DRIVEN}
    assert "robot bench has an actuator already" in second.text


def test_what_the_watchdog_sees_can_be_asked(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    watching = "watching: the actuator steps, last "
    with bench.driven():
        seen = rig.result("watchdog", "--once", *rig.bus_options())
        why = rig.result("why", *rig.bus_options())
    assert (seen.returncode, seen.stderr, seen.stdout.count("\n")) == (0, "", 1)
    assert seen.stdout.startswith(f"bench  {watching}")
    assert "sees pulses that move, and by what it heard somebody may drive" in seen.stdout
    lines = why.stdout.splitlines()
    assert lines[0] == "bench is driving: keyboard drives"
    names = [line.split()[0] for line in lines[1:]]
    assert names == ["operator", "mux", "gate", "rest", "cap", "limiter", "wheels", "watchdog"]
    assert watching in lines[-1]


def test_nobody_there_is_said_within_seconds(rig: Rig) -> None:
    for verb, words in (("watchdog", "no watchdog of bench has been heard"), ("why", "no actuator of bench")):
        done = rig.result(verb, "--robot", "bench", "--no-multicast-scouting")
        assert (done.returncode, done.stdout) == (1, "")
        assert words in done.stderr


def test_neutral_brings_a_chip_to_rest_that_both_processes_left_driving(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    with bench.driven():
        for pid in (bench.watchdog.process.pid, bench.watchdog.child):
            os.kill(pid, signal.SIGSTOP)
        done = rig.result("neutral", "--robot", "bench")
        assert done.returncode == 1
        assert f"is driven by process {bench.watchdog.process.pid} already; stop it first" in done.stderr
        assert rig.ticks == NEUTRAL
        for pid in (bench.watchdog.child, bench.watchdog.process.pid):
            os.kill(pid, signal.SIGKILL)
    bench.watchdog.ends()
    done = rig.result("neutral", "--robot", "bench")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "at rest: throttle 1510 us = 370 ticks, steering 1530 us = 375 ticks\n"


def test_a_chip_that_browns_out_is_repaired_through_neutral(rig: Rig) -> None:
    with Path(rig.folder, "config.toml").open("a") as file:
        file.write("arming = 0.5\n")
    bench = Bench(rig, rig.actuator())
    with Faults(rig.chip) as faults, bench.driven():
        bench.statuses.newest()
        faults.brown_out()
        with Watch(rig) as watch:
            hear(bench.statuses, lambda status: status.state in ("fault", "starting"), "a fault")
            hear(bench.statuses, lambda status: status.state == "starting", "an ESC that arms")
            hear(bench.statuses, lambda status: status.state == "idle", "an end of it")
            bench.stays_neutral()
        assert {ticks for ticks in watch.seen if None not in ticks} == {NEUTRAL}
        bench.watchdog.says("the chip is at fault")
        bench.watchdog.says("the chip is back, at neutral")
    time.sleep(0.6)  # let go: the publisher's own silence
    with bench.driven():
        pass
    assert not bench.stop_file.exists()


def test_a_chip_that_does_not_answer_is_a_fault_until_it_does(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    with Faults(rig.chip) as faults, bench.driven():
        faults.nack(2**32 - 1)
        hear(bench.statuses, lambda status: status.state == "fault", "a fault")
        faults.clear()
        assert bench.neutral_after() <= 0.5
        hear(bench.statuses, lambda status: status.state == "idle", "an end of it")
        bench.stays_neutral()
    assert not bench.stop_file.exists()


HOURS_AHEAD = ["unshare", "--time", "--boottime", "36000", "--kill-child"]


def test_a_sender_whose_clock_is_ten_hours_ahead_drives_as_any_other(rig: Rig) -> None:
    asked = subprocess.run([*HOURS_AHEAD, "cat", "/proc/uptime"], capture_output=True, text=True)
    if asked.returncode:
        pytest.skip(f"no time namespace here: {asked.stderr.strip()}")
    bench = Bench(rig, rig.actuator())
    values = f"{{steering_ticks: {FORWARD.steering_ticks}, throttle_ticks: {FORWARD.throttle_ticks}}}"
    publish = ["pub", "pwm/keyboard", "Pwm", values, "-r", "50", *rig.bus_options()]
    sender = rig._keep(Process([*HOURS_AHEAD, *ZTELEOP, *publish], rig.environment, rig.folder))
    bench.moves()
    with Watch(rig) as watch:
        status = hear(bench.statuses, lambda status: status.state == "driving", "driving")
        for _ in every(0.1, 10):
            pass
    assert watch.seen == {DRIVEN}
    assert (status.source, status.refused) == ("keyboard", 0)
    sender.signal(signal.SIGKILL)
    assert bench.neutral_after() <= 0.3 + BUSY
    assert "refused" not in bench.watchdog.text
    assert not bench.stop_file.exists()
