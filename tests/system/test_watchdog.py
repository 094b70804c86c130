"""The watchdog against actuators that do not do as they must, measured at the chip from outside."""

import os
import re
import signal
import subprocess
from pathlib import Path

import pytest
from bench import DRIVEN, FORWARD, LEAVES_SLOWLY, MOVES_BY_ITSELF, Bench, defective
from rig import NEUTRAL, ZTELEOP, Process, Rig, Watch, every, hear, repeating

from zteleop.drivers.faults import Faults
from zteleop.messages import DriveStatus, Log

CLOSED = """
import os, sys
for number in range(3):
    os.close(number)
os.execv(sys.executable, [sys.executable, "-m", "zteleop", *sys.argv[1:]])
"""


def test_an_actuator_that_moves_by_itself_and_heeds_no_stop(rig: Rig) -> None:
    bench = defective(rig, MOVES_BY_ITSELF)
    with bench.driven():
        pass
    bench.watchdog.says("the chip is kept at rest and another starts")
    bench.rests()
    bench.is_latched("the watchdog")
    bench.stays_neutral()


def test_an_actuator_that_was_told_to_end_and_leaves_slowly_was_not_only_late(rig: Rig) -> None:
    bench = defective(rig, LEAVES_SLOWLY)
    with bench.driven():
        assert bench.watchdog.child
        os.kill(bench.watchdog.child, signal.SIGTERM)
        bench.rests()
        bench.watchdog.says("the actuator is gone: it ended")
        bench.watchdog.says(" is refused: it was moving before the robot was ready")
        bench.stays_neutral()


def test_with_its_standard_files_closed_no_log_line_goes_into_a_chip(rig: Rig) -> None:
    arguments = ["actuator", *rig.bus_options()[:-2], "--listen", rig.endpoint]
    robot = rig.program(CLOSED, *arguments)
    node = rig.node("truth")
    rig.hear(node)
    hear(node.subscription("drive_status", DriveStatus), lambda status: status.state == "idle", "idle")
    assert robot.child
    for pid in (robot.process.pid, robot.child):
        files = [os.readlink(f"/proc/{pid}/fd/{number}") for number in (1, 2)]
        assert files == [os.devnull] * 2
    logs, stranger = node.subscription("log", Log), rig.session()
    key = f"robot/{rig.robot}/pwm/keyboard"
    with Watch(rig) as watch, repeating(lambda: stranger.put(key, b"no command"), 0.1):
        hear(logs, lambda log: key in log.msg, "a line in the log")
    assert watch.seen == {NEUTRAL}
    robot.signal(signal.SIGTERM)
    assert robot.ends() == 143


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
        watch.saw_only(DRIVEN)
    assert "robot bench has an actuator already" in second.text


def test_what_the_watchdog_sees_can_be_asked(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    watching = "watching: the actuator steps, "
    with bench.driven():
        seen = rig.result("watchdog", "--once", *rig.bus_options())
        why = rig.result("why", *rig.bus_options())
    assert (seen.returncode, seen.stderr, seen.stdout.count("\n")) == (0, "", 1)
    assert seen.stdout.startswith(f"bench  {watching}")
    assert "sees pulses off neutral, and hears commands that allow motion" in seen.stdout
    lines = why.stdout.splitlines()
    assert re.fullmatch(r"bench is driving: keyboard \w{4} drives", lines[0])
    names = [line.split()[0] for line in lines[1:]]
    layers = ["operator", "gate", "mux", "rest", "cap", "limiter", "wheels"]
    assert names == [*layers, "watchdog", "odom", "who", "at"]
    assert watching in lines[-4]
    assert re.fullmatch(r"  who       keyboard \w{4} is test, process \d+ on \S+", lines[-2])


def test_nobody_there_is_said_within_seconds(rig: Rig) -> None:
    for verb, words in (("watchdog", "no watchdog of bench has been heard"), ("why", "no actuator of bench")):
        done = rig.result(verb, "--robot", "bench", "--no-multicast-scouting")
        assert done.returncode == 1
        assert words in done.stderr
        assert (words in done.stdout) is (verb == "why"), "a file that keeps the answer keeps this one"


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
    assert done.stdout == (
        f"bench at rest, in the simulated chip {rig.chip}: "
        "throttle 1510 us = 370 ticks, steering 1530 us = 375 ticks\n"
    )


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
    bench.pwm.let_go()
    with bench.driven():
        pass
    assert not bench.stop_file.exists()


def test_a_chip_that_does_not_answer_is_a_fault_until_it_does(rig: Rig) -> None:
    bench = Bench(rig, rig.actuator())
    with Faults(rig.chip) as faults, bench.driven():
        faults.nack(2**32 - 1)
        hear(bench.statuses, lambda status: status.state == "fault", "a fault")
        faults.clear()
        bench.rests()
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
    sender = rig.keep(Process([*HOURS_AHEAD, *ZTELEOP, *publish], rig.environment, rig.folder))
    bench.moves()
    with Watch(rig) as watch:
        status = hear(bench.statuses, lambda status: status.state == "driving", "driving")
        for _ in every(0.1, 10):
            pass
    watch.saw_only(DRIVEN)
    assert (status.source, status.refused) == ("keyboard", 0)
    sender.signal(signal.SIGKILL)
    bench.rests()
    assert "refused" not in bench.watchdog.text
    assert not bench.stop_file.exists()
