"""Whoever is refused is told at the own end, and what a program does about it on purpose."""

import re
import signal

from rig import NEUTRAL, Process, Rig, Watch, every, hear, until

from zteleop.chaos.cable import Cable
from zteleop.messages import DriveStatus

PROGRAM = """
from zteleop import BusSettings, Node, Twist

with Node("pub_motor", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False)) as node:
    motors = node.publisher("cmd_vel", Twist, source="buttons")
    then = ""

    @node.every(0.1)
    def turn() -> None:
        global then
        motors.publish(Twist.planar(linear=0.2, angular=0.4))
        if motors.refused != then:
            then = motors.refused
            print(f"refused is now {then!r}", flush=True)

    node.spin()
"""
DRIVE = ("pub", "cmd_vel", "Twist", "{linear: {x: 0.3}}", "-r", "10")
REFUSED = "cmd_vel is refused by robot bench: it was m"


def moves(rig: Rig) -> None:
    until(lambda: rig.ticks not in (NEUTRAL, (None, None)), "motion")


def drives(rig: Rig, shell: Process) -> None:
    """Wait until a shell drives, and has had time to hear that it does."""
    moves(rig)
    said = len(shell.lines)
    until(lambda: len(shell.lines) > said + 20, "ten more commands")


def restart(rig: Rig, actuator: Process) -> Process:
    actuator.signal(signal.SIGKILL)
    actuator.ends()
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    return rig.actuator()


def release(rig: Rig) -> None:
    assert rig.result("stop", "--release", *rig.bus_options()).returncode == 0


def test_a_restarted_robot_is_told_of_by_a_shell_and_by_a_program(rig: Rig) -> None:
    actuator = rig.actuator()
    shell = rig.join(*DRIVE)
    moves(rig)
    program = rig.program(PROGRAM.replace("{endpoint}", rig.endpoint))
    statuses = rig.node().subscription("drive_status", DriveStatus)
    hear(statuses, lambda status: status.source == "buttons", "the program")
    restart(rig, actuator)
    with Watch(rig) as watch:
        assert shell.says(f"warning: {REFUSED}").startswith("pub: ")
        program.says(f"pub_motor: warning: {REFUSED}")
        program.says("refused is now 'it was m")
        said = len(shell.lines)
        until(lambda: len(shell.lines) > said + 20, "the shell to go on")
    assert watch.seen == {NEUTRAL}
    assert shell.text.count("is refused") == 1
    shell.signal(signal.SIGINT)
    assert shell.ends() == 130


def test_settings_that_are_changed_under_a_robot_are_told(rig: Rig) -> None:
    actuator = rig.actuator()
    rig.set('keymap = "wasd"')
    actuator.says("config.toml has changed; what it says counts once this is started again")


def test_a_robot_that_is_gone_and_comes_back_is_told_of(rig: Rig) -> None:
    actuator = rig.actuator()
    shell = rig.join(*DRIVE)
    moves(rig)
    actuator.signal(signal.SIGKILL)
    actuator.ends()
    shell.says("robot bench is not heard any more; what is said on cmd_vel moves nothing")
    rig.actuator()
    shell.says("robot bench is heard")


def test_who_typed_resume_drives_on_after_a_restart_and_not_after_a_stop(rig: Rig) -> None:
    actuator = rig.actuator()
    shell = rig.join(*DRIVE, "--resume")
    drives(rig, shell)
    again = restart(rig, actuator)
    shell.says("begins anew by itself")
    drives(rig, shell)
    assert rig.result("stop", *rig.bus_options()).returncode == 0
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    shell.says("is kept at rest")
    release(rig)
    with Watch(rig) as watch:
        until(lambda: shell.text.count(REFUSED) >= 2, "a second refusal")
        for _ in every(0.1, 20):
            pass
        restart(rig, again).says(" is refused: ")
        for _ in every(0.1, 20):
            pass
    assert watch.seen == {NEUTRAL}
    assert shell.text.count("begins anew by itself") == 1


def test_a_stop_that_came_and_went_while_the_link_was_cut_needs_a_person(rig: Rig) -> None:
    """Nobody but the robot can tell of that stop, and the robot itself was restarted since."""
    actuator = rig.actuator()
    with Cable(rig.port) as cable:
        shell = rig.run(*DRIVE, "--resume", *rig.bus_options(f"tcp/127.0.0.1:{cable.port}"))
        drives(rig, shell)
        cable.cut()
        until(lambda: rig.ticks == NEUTRAL, "neutral")
        assert rig.result("stop", *rig.bus_options()).returncode == 0
        release(rig)
        again = restart(rig, actuator)
        with Watch(rig) as watch:
            cable.mend()
            again.says(" is refused: ")
            shell.says("cmd_vel is refused")
            for _ in every(0.1, 20):
                pass
        assert watch.seen == {NEUTRAL}
    assert "begins anew" not in shell.text


def test_the_second_of_two_keyboards_shows_why_it_does_not_drive(rig: Rig) -> None:
    rig.actuator()
    first, second = rig.keyboard(columns=120), rig.keyboard(columns=120)
    for keyboard in (first, second):
        keyboard.shows("idle, nobody operates")
    first.type("a")
    first.shows("driving, you operate")
    second.type("d")
    second.shows(" drives this source")
    first.shows("driving, you operate", " is refused: another sender drives")
    refused = re.search(r"keyboard \w{4} is refused", first.screen)
    first.type("x")
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    second.type("x")
    second.shows("straight", "idle, nobody operates")
    second.type("d")
    second.shows("driving, you operate")
    second.shows("outputting:[Steering PWM, Throttle PWM] = [360, 370]")
    first.shows("driving, keyboard")
    drives_now = re.search(r"keyboard \w{4} operates", first.screen)
    assert refused, first.screen
    assert drives_now, first.screen
    assert refused[0].split()[:2] == drives_now[0].split()[:2], "one name for one sender"


def test_a_keyboard_of_a_robot_that_is_not_there_says_who_is_now(rig: Rig) -> None:
    actuator = rig.actuator()
    keyboard = rig.terminal("keyboard", "--no-multicast-scouting", "-e", rig.endpoint, "--robot", "bensh")
    keyboard.shows("no actuator heard on robot bensh (heard here: bench; did you mean bench?)")
    actuator.signal(signal.SIGINT)
    actuator.ends()
    keyboard.shows(f"no actuator heard on robot bensh (nothing answers at {rig.endpoint}")
    rig.actuator()
    keyboard.shows("no actuator heard on robot bensh (heard here: bench; did you mean bench?)")
    keyboard.type("q")
    assert keyboard.ends() == 0


LISTENER = """
from zteleop import BusSettings, Node, Odometry

with Node("ears", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False)) as node:
    for odometry in node.subscription("odom", Odometry):
        print(f"heard {odometry.pose.pose.position.x}", flush=True)
"""
SECOND = """
from zteleop import BusSettings, Node, Twist

with Node("second", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False)) as node:
    motors = node.publisher("cmd_vel", Twist)
    node.every(0.1)(lambda: motors.publish(Twist.planar(linear=0.2)))
    node.spin()
"""


def test_a_program_that_only_waits_for_messages_is_told_that_nobody_publishes(rig: Rig) -> None:
    rig.actuator()
    ears = rig.program(LISTENER.replace("{endpoint}", rig.endpoint))
    ears.says("ears: warning: nobody publishes bench/odom")
    rig.join("pub", "odom", "Odometry", "{pose: {pose: {position: {x: 2.5}}}}", "-r", "10")
    ears.says("bench/odom is published now")
    ears.says("heard 2.5")
    ears.signal(signal.SIGINT)
    ears.ends()
    assert ears.text.count("nobody publishes") == 1


def test_a_second_program_is_told_when_the_first_is_done(rig: Rig) -> None:
    rig.actuator()
    first = rig.join(*DRIVE)
    moves(rig)
    second = rig.program(SECOND.replace("{endpoint}", rig.endpoint))
    second.says(" drives this source; when that one is done, start this anew, or")
    assert re.search(r"refused by robot bench: program \w{4} drives this source", second.text)
    first.signal(signal.SIGINT)
    assert first.ends() == 130
    second.says("refused by robot bench: another sender drove this source when this one began, and is done")
    assert rig.ticks == NEUTRAL, "what was asked for meanwhile drives nothing by itself"
