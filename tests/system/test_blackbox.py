"""The black box of a robot that runs, stops, fails and crashes, written by real processes."""

import gzip
import json
import os
import re
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import zenoh
from rig import NEUTRAL, Process, Rig, every, repeating, until

from zteleop.bus import presence
from zteleop.bus.node import Node
from zteleop.messages import Pwm, String

FORWARD, DRIVEN = Pwm(390, 400), (390, 400)
RATE = 0.05
PATIENT: dict[str, Any] = {"congestion_control": zenoh.CongestionControl.BLOCK}
"""else zenoh drops what does not leave within a millisecond: 50 kB beside busy loops once in forty times"""


class Accident:
    """A robot whose black box listens, and somebody who can drive it."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.watchdog: Process = rig.actuator()
        self.node: Node = rig.node()
        rig.hear(self.node)
        self.pwm = self.node.publisher("pwm", Pwm, source="keyboard")
        until(lambda: presence.holders(self.node.membership.session, rig.robot, "blackbox"), "a black box")

    @property
    def folder(self) -> Path:
        return Path(self.rig.environment["XDG_STATE_HOME"]) / f"zteleop/robots/{self.rig.robot}/blackbox"

    @property
    def recorder(self) -> int:
        """The process of the black box; 0 while there is none."""
        return self.watchdog.recorder or 0

    def drive(self, seconds: float = 0.5) -> None:
        """Drive for a while, and then fall silent."""
        with repeating(lambda: self.pwm.publish(FORWARD), RATE):
            until(lambda: self.rig.ticks == DRIVEN, "the command on the chip")
            time.sleep(seconds)

    def files(self, reason: str) -> list[Path]:
        return sorted(self.folder.glob(f"*-{reason}.jsonl.gz")) if self.folder.is_dir() else []

    def file(self, reason: str) -> list[dict[str, Any]]:
        """Wait for a file; return its lines."""
        until(lambda: self.files(reason), f"a black box because of {reason}")
        return [json.loads(line) for line in gzip.open(self.files(reason)[0])]

    def told(self, *arguments: str) -> str:
        result = self.rig.result("blackbox", *arguments)
        assert (result.returncode, result.stderr) == (0, "")
        return result.stdout


@pytest.fixture
def bench(rig: Rig) -> Accident:
    return Accident(rig)


def in_order(text: str, *facts: str) -> None:
    """Check that all these facts are told, one after the other."""
    place = 0
    for fact in facts:
        found = text.find(fact, place)
        assert found >= 0, f"{fact!r} is not told, or not there:\n{text}"
        place = found


def test_a_sender_that_falls_silent_is_told_with_all_that_it_did(bench: Accident) -> None:
    bench.drive()
    header, *lines = bench.file("link-lost")
    assert header["robot"] == bench.rig.robot
    assert re.fullmatch(r"keyboard \w{4} has been silent for 0.3 s", header["why"])
    keys = {line["key"].removeprefix(f"robot/{bench.rig.robot}/") for line in lines}
    assert {"pwm/keyboard", "beat", "drive_status", "vehicle", "why", "watchdog"} <= keys
    assert [line["at"] for line in lines] == sorted(line["at"] for line in lines)
    sent = [line for line in lines if line["key"].endswith("pwm/keyboard")]
    assert all(line["payload"] == {"steering_ticks": 390, "throttle_ticks": 400} for line in sent)
    numbers = [line["proof"][1] for line in sent]
    assert numbers == list(range(numbers[0], numbers[0] + len(sent))), "not every command is kept"
    in_order(
        bench.told(),
        f"black box of {bench.rig.robot}: link lost",
        f"keyboard {bench.pwm.sender[-4:]} begins: steering 390, throttle 400",
        f"driving: keyboard {bench.pwm.sender[-4:]} drives",
        f"keyboard {bench.pwm.sender[-4:]} says its last word (20 a second until then)",
        "0.00 s  link lost: keyboard ",
        "has been silent for 0.3 s   <- written because of this",
        "pulses at rest: steering 375, throttle 370",
    )


def test_a_stop_is_told_with_who_and_why(bench: Accident) -> None:
    with repeating(lambda: bench.pwm.publish(FORWARD), RATE):
        until(lambda: bench.rig.ticks == DRIVEN, "the command on the chip")
        bench.rig.result("stop", "--why", "a child", *bench.rig.bus_options())
        bench.file("stop")
    told = bench.told()
    (reason,) = [line for line in told.splitlines() if line.endswith("<- written because of this")]
    in_order(told, "begins", reason)
    # A stop reaches the robot without the bus as well: its own word may come first, and says as much.
    assert re.search(r" 0\.00 s  (.+ says stop|stopped: stopped by .+): a child", reason)
    assert "says stop: a child" in told
    assert "stopped: stopped by " in told


def test_an_actuator_that_is_killed_is_told(bench: Accident) -> None:
    actuator = bench.watchdog.child
    assert actuator
    bench.drive()
    os.kill(actuator, signal.SIGKILL)
    bench.file("actuator-ended")
    rest = ("driving: ", "the watchdog reads pulses of rest", "watchdog resting: the actuator is gone")
    told = bench.told()
    in_order(told, *rest, "<- written because of this", "another actuator is started")
    assert "pulses at rest" not in told, "which they were long before the next actuator said so"


def test_an_actuator_that_rests_as_nobody_watches_it_is_told_when_it_does(bench: Accident) -> None:
    with repeating(lambda: bench.pwm.publish(FORWARD), RATE):
        until(lambda: bench.rig.ticks == DRIVEN, "the command on the chip")
        bench.watchdog.signal(signal.SIGSTOP)
        until(lambda: bench.rig.ticks == NEUTRAL, "rest")
        time.sleep(1.0)
    bench.watchdog.signal(signal.SIGCONT)
    bench.file("actuator-ended")
    told = bench.told()
    words = "actuator reports an error: the watchdog has been silent for 0."
    in_order(told, "driving: ", words, " s; the robot is at rest", "watchdog resting: the actuator is gone")
    assert "pulses at rest" not in told
    assert bench.watchdog.text.count("the watchdog has been silent") == 1


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSEGV])
def test_a_watchdog_that_dies_is_told(bench: Accident, number: int) -> None:
    recorder = bench.recorder
    with repeating(lambda: bench.pwm.publish(FORWARD), RATE):
        until(lambda: bench.rig.ticks == DRIVEN, "the command on the chip")
        bench.watchdog.signal(number)
        bench.file("watchdog-ended")
    in_order(bench.told(), "begins", "watchdog ended: it said no farewell   <- written because of this")
    until(lambda: not Path(f"/proc/{recorder}").exists(), "the end of the black box")


def test_a_robot_that_is_told_to_end_writes_nothing_and_leaves_nobody(bench: Accident) -> None:
    recorder = bench.recorder
    bench.watchdog.signal(signal.SIGTERM)
    assert bench.watchdog.ends() == 128 + signal.SIGTERM
    until(lambda: not Path(f"/proc/{recorder}").exists(), "the end of its black box")
    assert not bench.folder.exists()


def test_a_robot_that_is_told_to_end_soon_after_a_stop_writes_first(bench: Accident) -> None:
    bench.rig.result("stop", *bench.rig.bus_options())
    bench.watchdog.signal(signal.SIGTERM)
    assert bench.watchdog.ends() == 128 + signal.SIGTERM
    assert len(bench.files("stop")) == 1


def test_under_systemd_a_watchdogs_death_ends_both_and_is_told(bench: Accident) -> None:
    """The signal to end follows at once on the death that is the reason."""
    recorder = bench.recorder
    bench.watchdog.signal(signal.SIGKILL)
    bench.watchdog.process.wait()
    os.kill(recorder, signal.SIGTERM)
    bench.file("watchdog-ended")


def test_a_place_that_cannot_be_written_is_told_once_and_the_robot_drives_on(bench: Accident) -> None:
    bench.folder.parent.mkdir(parents=True, exist_ok=True)
    bench.folder.write_text("somebody's file")
    bench.rig.result("stop", *bench.rig.bus_options())
    bench.watchdog.says("blackbox: warning: the black box cannot be kept")
    bench.rig.result("stop", "--release", *bench.rig.bus_options())
    bench.drive(0.1)
    bench.watchdog.signal(signal.SIGTERM)
    assert bench.watchdog.ends() == 128 + signal.SIGTERM
    assert bench.watchdog.text.count("the black box cannot be kept") == 1
    assert bench.folder.read_text() == "somebody's file"


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_black_box_that_dies_or_stands_still_harms_nobody(bench: Accident, number: int) -> None:
    recorder = bench.recorder
    with repeating(lambda: bench.pwm.publish(FORWARD), RATE):
        until(lambda: bench.rig.ticks == DRIVEN, "the command on the chip")
        os.kill(recorder, number)
        for _ in every(0.004, 500):
            assert bench.rig.ticks[1] > NEUTRAL[1], "it drives on"
        if number == signal.SIGKILL:
            until(lambda: bench.recorder not in (0, recorder), "another black box")


def test_a_black_box_that_stands_still_holds_up_no_command_behind_what_must_arrive(bench: Accident) -> None:
    """What may not be dropped waits for who does not take it, and in the watchdog all waits with it."""
    session = bench.rig.session()
    junk = session.declare_publisher(f"robot/{bench.rig.robot}/junk", **PATIENT)
    recorder = bench.recorder
    with repeating(lambda: bench.pwm.publish(FORWARD), RATE):
        until(lambda: bench.rig.ticks == DRIVEN, "the command on the chip")
        os.kill(recorder, signal.SIGSTOP)
        try:
            for _ in every(0.005, 500):
                for _ in range(100):
                    junk.put(bytes(1000))
                assert bench.rig.ticks == DRIVEN
        finally:
            os.kill(recorder, signal.SIGCONT)


def test_the_drive_knows_nothing_of_it_where_it_is_off(rig: Rig) -> None:
    rig.set("blackbox = false")
    watchdog = rig.actuator()
    node = rig.node()
    rig.hear(node)
    time.sleep(2.0)  # twice the time after which it would start
    assert watchdog.recorder is None
    assert presence.holders(node.membership.session, rig.robot, "blackbox") == []


HOSTILE: dict[str, Callable[[Any, str], object]] = {
    "no message": lambda session, robot: session.put(f"{robot}/pwm/keyboard", b"hello\x1b[2J", **PATIENT),
    "a wildcard": lambda session, robot: session.put("robot/*/stop", b"{}", **PATIENT),
    "a delete": lambda session, robot: session.delete(f"{robot}/stop", **PATIENT),
    "depth": lambda session, robot: session.put(f"{robot}/odd", b"[" * 50_000, **PATIENT),
    "an endless name": lambda session, robot: session.put(f"{robot}/{'x' * 5000}", b"1", **PATIENT),
    "a large one": lambda session, robot: session.put(f"{robot}/odd", bytes(900_000), **PATIENT),
}


def test_whatever_is_said_it_is_told_and_nobody_dies(bench: Accident) -> None:
    recorder = bench.recorder
    node = bench.rig.node("odd")
    odd = node.publisher("odd", String)
    until(lambda: odd.matched, "the black box")
    session = node.membership.session.zenoh  # another would learn of the black box later
    for say in HOSTILE.values():
        say(session, f"robot/{bench.rig.robot}")
    bench.rig.result("stop", *bench.rig.bus_options())
    bench.file("stop")
    assert bench.recorder == recorder
    told = bench.told()
    in_order(told, "pwm/keyboard: nobody understood a message", "<- written because of this")
    assert "robot/*/stop: nobody understood a message" in told
    everything = bench.told("--all")
    assert "robot/bench/odd " in everything
    assert "\x1b" not in told + everything


def test_echo_begins_with_what_was_said_before(bench: Accident) -> None:
    """And goes on with what is said since, each once."""
    said = [Pwm(375, 370 + number) for number in range(4)]
    for message in said[:2]:
        bench.pwm.publish(message)
    options = ("--since", "30s", "--json", "--filter", "m.steering_ticks == 375", *bench.rig.bus_options())
    echo = bench.rig.run("echo", "pwm", *options)
    echo.says('"throttle_ticks":371')
    for message in said[2:]:
        bench.pwm.publish(message)
    echo.says('"throttle_ticks":373')
    shown = [json.loads(line)["throttle_ticks"] for line in echo.text.splitlines() if line.startswith("{")]
    assert shown == [370, 371, 372, 373]
