"""A stop, from a key and from a shell, to the chip: it comes at once, it stays, and it ends on purpose."""

import os
import re
import signal
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Process, Rig, Terminal, Watch, every, hear, repeating, until

from zteleop.bus.subscription import Subscription
from zteleop.messages import DriveStatus, Stop, Twist

UP, LEFT, DELETE = "\x1b[A", "\x1b[D", "\x7f"
OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
REPEAT = 0.04
STOPPED = re.compile(
    r"bench is stopped \(neutral read back from the chip within \d+ ms\); "
    r"zteleop stop --release bench lets it drive again, from neutral\n"
    r"goes on saying so until 3 s are over, to whoever comes late; the stop outlasts this\n"
)
RELEASED = re.compile(r"bench may drive again, from neutral \(acknowledged within \d+ ms\)\n")


@pytest.fixture
def actuator(rig: Rig) -> Process:
    return rig.actuator()


@pytest.fixture
def statuses(rig: Rig, actuator: Process) -> Subscription[DriveStatus]:
    """What the robot shows, to a node that has heard it."""
    node = rig.node("looker")
    rig.hear(node)
    return node.subscription("drive_status", DriveStatus)


@pytest.fixture
def keyboard(rig: Rig, actuator: Process) -> Terminal:
    keyboard = rig.keyboard()
    keyboard.shows(" idle")
    return keyboard


@pytest.fixture
def driving(rig: Rig, actuator: Process) -> Iterator[None]:
    """A program that drives all the time, and lets go for a moment every half second."""
    node = rig.node("driver")
    rig.hear(node)
    motors = node.publisher("cmd_vel", Twist)
    turns = 0

    def drive() -> None:
        nonlocal turns
        turns += 1
        motors.publish(Twist.planar(0.5 if turns % 25 else 0.0))

    with repeating(drive, 0.02):
        drives(rig)
        yield


def drives(rig: Rig) -> None:
    until(lambda: rig.ticks[1] > NEUTRAL[1], "the throttle above neutral")


def rests(rig: Rig) -> None:
    until(lambda: rig.ticks == NEUTRAL, "neutral on the chip")


def stays_neutral(rig: Rig, seconds: float) -> None:
    for _ in every(0.005, round(seconds / 0.005)):
        assert rig.ticks == NEUTRAL


def in_force(statuses: Subscription[DriveStatus]) -> DriveStatus:
    return hear(statuses, lambda status: status.state == "stopped", "a robot that is stopped")


def stop_by_shell(rig: Rig, *arguments: str) -> None:
    done = rig.result("stop", *arguments, *rig.bus_options())
    assert (done.returncode, done.stderr) == (0, "")
    assert (RELEASED if "--release" in arguments else STOPPED).fullmatch(done.stdout), done.stdout


def test_a_stop_that_is_pressed_holds_until_it_is_released_and_arms_nothing(
    rig: Rig, keyboard: Terminal
) -> None:
    for _ in range(3):
        keyboard.type(LEFT + UP)
        until(lambda: rig.ticks == (390, 374), "levers on the chip")
        keyboard.type(DELETE)
        rests(rig)
        keyboard.shows("● stopped", "bench is stopped (neutral read back", f"{OUTPUT}[375, 370]")
        keyboard.type("r")
        keyboard.shows("● idle", "bench may drive again, from neutral")
        stays_neutral(rig, 0.7)  # and a key typed now is a new press: the last one is long over


def test_a_stop_is_stronger_than_whoever_goes_on_driving(
    rig: Rig, statuses: Subscription[DriveStatus], driving: None
) -> None:
    stops = rig.node("stopper").publisher("stop", Stop)
    until(lambda: stops.matched, "somebody who hears stops")
    for number in range(1, 4):
        drives(rig)
        stops.publish(Stop(True, number, "ann", ""))
        rests(rig)
        stays_neutral(rig, 0.7)
        stops.publish(Stop(False, number, "ann", ""))


def test_a_stop_typed_in_a_shell_stays_until_it_is_released(rig: Rig, driving: None) -> None:
    stop_by_shell(rig, "--why", "a cat")
    stays_neutral(rig, 0.7)
    reason = rig.result("why", *rig.bus_options()).stdout
    assert re.search(r"bench is stopped: stopped by \S+@\S+: a cat; zteleop stop --release", reason)
    stop_by_shell(rig, "--release")
    drives(rig)
    done = rig.result("stop", "--release", *rig.bus_options())
    assert (done.returncode, done.stdout, done.stderr) == (0, "bench is not stopped\n", "")


def test_a_stop_survives_the_actuator_and_its_watchdog(
    rig: Rig, actuator: Process, statuses: Subscription[DriveStatus], driving: None
) -> None:
    stop_by_shell(rig)
    stops = in_force(statuses).stops
    with Watch(rig) as watch:
        child = actuator.child
        assert child
        os.kill(child, signal.SIGKILL)
        until(lambda: actuator.child not in (None, child), "another actuator")
        statuses.newest()
        assert in_force(statuses).stops == stops
        actuator.signal(signal.SIGKILL)
        actuator.ends()
        rig.actuator()
        statuses.newest()
        assert in_force(statuses).stops == stops
    assert "stopped since before its start: stopped by " in rig.result("why", *rig.bus_options()).stdout
    assert watch.seen == {NEUTRAL}
    stop_by_shell(rig, "--release")
    drives(rig)


def test_a_release_moves_nothing_that_is_held_until_it_is_let_go_and_pressed_again(
    rig: Rig, actuator: Process
) -> None:
    keyboard = rig.keyboard("--drive", "hold")
    keyboard.shows(" idle")
    with repeating(lambda: keyboard.type("w"), REPEAT):
        drives(rig)
        stop_by_shell(rig)
        keyboard.shows("● stopped")
        stop_by_shell(rig, "--release")
        keyboard.shows("● idle")
        stays_neutral(rig, 0.7)
    stays_neutral(rig, 0.7)
    with repeating(lambda: keyboard.type("w"), REPEAT):
        drives(rig)


def test_levers_moved_while_stopped_stand_at_neutral_when_it_is_released(
    rig: Rig, keyboard: Terminal
) -> None:
    stop_by_shell(rig)
    keyboard.shows("● stopped", "backspace STOP   r release")
    keyboard.type(LEFT + UP)
    keyboard.shows("asked     [390, 374]  not obeyed", f"{OUTPUT}[375, 370]")
    keyboard.type("r")
    keyboard.shows("● idle", f"{OUTPUT}[375, 370]")
    stays_neutral(rig, 0.7)
    keyboard.type(UP)
    until(lambda: rig.ticks == (375, 374), "a new act on the chip")


def test_of_two_stops_by_two_people_each_is_released_by_its_own_name(
    rig: Rig, keyboard: Terminal, statuses: Subscription[DriveStatus], driving: None
) -> None:
    bob = Stop(True, 42, "bob@sofa", "somebody is under the car")
    stops = rig.node("sofa").publisher("stop", Stop)
    until(lambda: stops.matched, "somebody who hears stops")
    stops.publish(bob)
    hear(statuses, lambda status: status.stops == [bob], "bob's stop")
    keyboard.type(DELETE)
    keyboard.shows("bench is stopped (neutral read back from the chip")
    keyboard.type("r")
    keyboard.shows("yours is released, but bench is stopped by bob@sofa")
    assert hear(statuses, lambda status: len(status.stops) < 2, "one released").stops == [bob]
    stays_neutral(rig, 0.7)
    refused = rig.result("stop", "--release", *rig.bus_options())
    assert (refused.returncode, refused.stdout) == (1, "")
    assert (
        "bench is stopped by bob@sofa (somebody is under the car); each releases their own" in refused.stderr
    )
    stop_by_shell(rig, "--release", "--all")
    drives(rig)


def test_both_stops_survive_a_robot_that_is_switched_off_and_on(
    rig: Rig, actuator: Process, statuses: Subscription[DriveStatus]
) -> None:
    stops = rig.node("sofa").publisher("stop", Stop)
    until(lambda: stops.matched, "somebody who hears stops")
    both = [Stop(True, number, by, "") for number, by in ((42, "bob@sofa"), (43, "ann@desk"))]
    for stop in both:
        stops.publish(stop)
    hear(statuses, lambda status: status.stops == both, "both stops")
    actuator.signal(signal.SIGKILL)
    actuator.ends()
    rig.actuator()
    statuses.newest()
    assert in_force(statuses).stops == both


def test_a_name_that_no_robot_has_is_told_with_those_that_are_heard(rig: Rig, actuator: Process) -> None:
    where = [word for word in rig.bus_options() if word not in ("--robot", rig.robot)]
    done = rig.result("stop", "gabriel", *where)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("gabriel does not answer so far, and is asked on; heard here: bench\n")


def test_a_robot_that_nobody_reaches_is_an_alarm_with_what_to_do(rig: Rig) -> None:
    shell = rig.join("stop")
    keyboard = rig.keyboard()
    keyboard.shows("no actuator")
    keyboard.type(DELETE)
    keyboard.shows("asking bench to stop")
    assert shell.ends() == 1
    assert shell.text == (
        f"bench does not answer so far, and is asked on; nothing answers at {rig.endpoint}: "
        "is the address right, and the robot on?\n"
        "zteleop stop: bench has not acknowledged the stop within 2 s: "
        "cut its power, or run zteleop neutral --robot bench on it"
    )
    keyboard.shows("bench has not acknowledged the stop within 2 s: cut its power")
    keyboard.type("q")
    assert keyboard.ends() == 1
    assert b"zteleop keyboard: bench has not acknowledged the stop" in keyboard.output


@pytest.mark.parametrize("typo", ['robt = "michael"', "robot =", '[bus]\nmode = "pear"', "[[[\0"])
def test_a_stop_goes_out_whatever_the_config_says(rig: Rig, driving: None, typo: str) -> None:
    file = rig.folder / "config.toml"
    right = file.read_text()
    file.write_text(f"{typo}\n{right}")
    done = rig.result("stop", *rig.bus_options())
    assert (done.returncode, done.stdout.partition(" (")[0]) == (0, "bench is stopped"), done.stderr
    assert done.stderr.startswith("zteleop: warning: config.toml:")
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    for verb in ("why", "neutral"):
        assert "warning: config.toml:" in rig.result(verb, "--robot", "bench").stderr
