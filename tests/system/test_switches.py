"""A key that is a switch, and whoever hears it."""

from rig import Rig, until

from zteleop.messages import Bool


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
