"""A key that is a switch, and whoever hears it."""

from itertools import pairwise

from rig import Rig, until

from zteleop.messages import Bool, Odometry

PRESSES = 61


def test_a_key_switches_what_any_program_hears_also_one_that_comes_later(rig: Rig) -> None:
    rig.set('[keys]\nl = "toggle lights"\n')
    rig.actuator()
    keyboard = rig.keyboard()
    keyboard.shows("nobody operates", "switches  lights off")
    early = rig.node("early").subscription("lights", Bool)
    until(lambda: early.newest() == Bool(False), "what was never touched is off")
    keyboard.type("l")
    keyboard.shows("switches  lights on")
    until(lambda: early.newest() == Bool(True), "on")
    late = rig.node("late").subscription("lights", Bool)
    until(lambda: late.newest() == Bool(True), "still on")


def test_a_switch_of_a_topic_that_is_something_else_is_refused_before_there_is_a_screen(rig: Rig) -> None:
    rig.set('[keys]\nl = "toggle odom"\n')
    keyboard = rig.keyboard()
    assert keyboard.ends() == 1
    assert b"no switch can be called odom: that is a topic of Odometry" in keyboard.output
    keyboard.is_as_found()


def test_no_key_is_lost_at_thirty_a_second_beside_a_hundred_messages_a_second(rig: Rig) -> None:
    rig.set('[keys]\nl = "toggle lights"\n')
    rig.actuator()
    keyboard = rig.keyboard(tells_releases=True)
    keyboard.shows("nobody operates", "switches  lights off")
    node, heard = rig.node("many"), []
    odometry = node.publisher("odom", Odometry)
    node.subscription("lights", Bool, lambda lights: heard.append(lights.message.data))
    node.every(1 / 100)(lambda: odometry.publish(Odometry.zero()))
    typed = 0

    def press() -> None:
        nonlocal typed
        if typed < PRESSES:
            typed += 1
            keyboard.key("l")
            keyboard.key("l", "release")
        elif heard and heard[-1]:
            node.stop()

    node.every(1 / 30)(press)
    node.spin(20.0)
    changes = [after for before, after in pairwise([False, *heard]) if before != after]
    assert changes == [bool(number % 2 == 0) for number in range(PRESSES)], "each press is said"
