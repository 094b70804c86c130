"""Each fault once, with real processes; `make soak` does them fifty times, and those under load as well."""

import json
import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

import preload
import pytest
from rig import NEUTRAL, PATIENCE, ZTELEOP, Rig, every, repeating, until
from verdict import Deadline, NotJudged, judged

from zteleop import chaos
from zteleop.chaos import load
from zteleop.chaos.bench import Subject
from zteleop.chaos.fault import Fault
from zteleop.chaos.trial import attempt, driven
from zteleop.config import Config
from zteleop.drivers.registers import read_duty_ticks
from zteleop.drivers.simulated import open_registers
from zteleop.messages import Pwm

FORWARD = Pwm(390, 400)
DRIVEN = (390, 400)
STREAM = 0.02
SILENCE = 0.37
"""s: the deadline, a beat's age, a step"""
LONG = {
    "actuator crashes",
    "watchdog crashes",
    "operator told to end",
    "keyboard back after 3 s",
    "link back after 3 s",
    "link cut from the robot",
    "link cut towards the robot",
    "link slower by half a second",
    "link of 4 kbit/s",
    "chip answers two times of three",
    "actuator killed, bus takes 100 ms",
    *(
        f"{what}, {how}"
        for what in ("operator killed", "actuator killed", "stop pressed")
        for how in ("bus fails 1 in 3", "bus fails at random", "bus takes 20 ms")
    ),
}
"""Left to `make soak`: another fault is much like it."""
LONG |= {
    fault.name for kind, fault in chaos.faults() if kind == "strangers" and fault.name.endswith(", stop")
}
SHORT = [fault for kind, fault in chaos.faults() if kind != "load" and fault.name not in LONG]


@pytest.mark.parametrize("fault", SHORT, ids=lambda fault: fault.name.replace(" ", "-"))
def test_a_fault_brings_neutral_in_time_and_for_good(fault: Fault, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(load, "WHILE", 1.5)
    outcome = attempt(Subject(Config(), ("--driver", "simulated")), fault)
    assert outcome.broken == ""
    if fault.bound is not None:
        assert outcome.seconds is not None
        judged(outcome.seconds, fault.bound, outcome.waited)


def test_the_real_driver_keeps_the_same_bounds_and_waits_for_consent(tmp_path: Path) -> None:
    chip = tmp_path / "chip"
    (tmp_path / "config.toml").write_text('driver = "pca9685"\n[drivers.pca9685]\nbus = 1\narming = 0.1\n')
    environment = os.environ | preload.environment(preload.library(tmp_path), chip)

    def chaos_on_wheels(consent: str) -> "subprocess.CompletedProcess[str]":
        command = [*ZTELEOP, "chaos", "--real", "--json", "--times", "1", "--only", "actuator killed"]
        said = {"capture_output": True, "text": True, "timeout": PATIENCE}
        return subprocess.run(command, input=consent, env=environment, cwd=tmp_path, **said)

    refused = chaos_on_wheels("yes\n")
    assert refused.returncode == 1
    assert refused.stderr.endswith("zteleop chaos: nothing was done: expected the words 'wheels up'\n")
    done = chaos_on_wheels("wheels up\n")
    verdicts = json.loads(done.stdout.splitlines()[-1])["verdicts"]
    assert {verdict["fault"] for verdict in verdicts} >= {"actuator killed", "operator and actuator killed"}
    assert all(words.startswith("it took") for verdict in verdicts for words in verdict["broken"])
    for verdict in verdicts:
        assert verdict["times"] + verdict["void"] >= 1
        if not verdict["times"]:
            raise NotJudged(f"{verdict['fault']} was void each time")
        judged(verdict["worst"], verdict["bound"], verdict["longest_wait"])


def test_nobody_drives_a_bench_before_its_actuator_is_there(tmp_path: Path) -> None:
    """Its operator waits a second for a robot, then holds on: one that began too early waits for ever."""
    late = "import sys, time\nif {'zteleop.processes', 'actuator'} <= {*sys.orig_argv}: time.sleep(2.5)"
    (tmp_path / "sitecustomize.py").write_text(late)  # which Python imports at each start
    subject = Subject(Config(), ("--driver", "simulated"), {"PYTHONPATH": str(tmp_path)})
    with driven(subject, SHORT[0]) as bench:
        assert not bench.eye.at_rest


def running(words: str) -> list[int]:
    """Return the processes whose command holds some words."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):  # it ends just now
            if words.encode() in path.read_bytes():
                found.append(int(path.parent.name))
    return found


def test_chaos_that_is_killed_itself_leaves_no_wheel_turning(tmp_path: Path) -> None:
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    command = [*ZTELEOP, "chaos", "--times", "50", "--only", "operator frozen"]
    killed = subprocess.Popen(command, env=environment, cwd=tmp_path, stdout=subprocess.DEVNULL)
    try:
        until(lambda: list(tmp_path.glob("*/zteleop/*.pca9685")), "a chip")
        chip = open_registers(str(next(tmp_path.glob("*/zteleop/*.pca9685"))))

        def rests() -> bool:
            return read_duty_ticks(chip.snapshot(), 1) in (None, NEUTRAL[0])

        until(lambda: not rests(), "the wheels turn")
        deadline = Deadline()
        killed.kill()
        deadline.met(rests, "the wheels are at rest", 0.5)
        for _ in every(0.005, 100):
            assert rests()
        chip.close()
        until(lambda: not running(str(tmp_path)), "nobody is left")
    finally:
        killed.kill()
        killed.wait()


def test_a_log_that_nobody_reads_holds_up_nobody(tmp_path: Path) -> None:
    ear, mouth = os.pipe()
    os.set_blocking(mouth, False)
    with suppress(BlockingIOError):
        while True:
            os.write(mouth, b"x" * 4096)
    os.set_blocking(mouth, True)
    with Rig(tmp_path) as rig:
        command = [*ZTELEOP, "actuator", "--robot", rig.robot, "--no-multicast-scouting"]
        robot = subprocess.Popen(
            [*command, "--listen", rig.endpoint], env=rig.environment, cwd=rig.folder, stderr=mouth
        )
        try:
            node = rig.node()
            rig.hear(node)
            publisher = node.publisher("pwm", Pwm, source="keyboard")
            with repeating(lambda: publisher.publish(FORWARD), STREAM):
                until(lambda: rig.ticks == DRIVEN, "the command on the chip")
                for _ in range(3):  # each is refused, and said so
                    rig.node().publisher("pwm", Pwm, source="keyboard").publish(FORWARD)
            Deadline(rig).met(lambda: rig.ticks == NEUTRAL, "neutral after silence", SILENCE)
            robot.terminate()
            assert robot.wait(PATIENCE) == 128 + signal.SIGTERM
        finally:
            robot.kill()
            robot.wait()
            os.close(ear)
            os.close(mouth)


@pytest.mark.parametrize("key", ["\x1a", "\x1c"], ids=["Ctrl-Z", "Ctrl-backslash"])
def test_no_key_of_its_terminal_leaves_the_wheels_turning(tmp_path: Path, key: str) -> None:
    with Rig(tmp_path) as rig:
        bus = ["--robot", rig.robot, "--no-multicast-scouting", "--listen", rig.endpoint]
        terminal = rig.terminal("actuator", *bus)
        terminal.shows("obeys")
        node = rig.node()
        rig.hear(node)
        publisher = node.publisher("pwm", Pwm, source="keyboard")
        with repeating(lambda: publisher.publish(FORWARD), STREAM):
            until(lambda: rig.ticks == DRIVEN, "the command on the chip")
            terminal.type(key)
            if key == "\x1c":
                until(lambda: rig.ticks == NEUTRAL, "neutral")
            else:
                terminal.shows("Ctrl-Z at the robot pauses nothing", "Ctrl-C there ends it")
                until(lambda: rig.ticks == DRIVEN, "it drives on")
        Deadline(rig).met(lambda: rig.ticks == NEUTRAL, "neutral after silence", SILENCE)
