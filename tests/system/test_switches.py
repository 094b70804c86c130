"""A key that is a switch, and whoever hears it."""

from rig import Rig, until

from zteleop.messages import Bool, Odometry

KEYS, TIMES = "0123456789", 7


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
    rig.set("[keys]\n" + "".join(f'{key} = "toggle lamp{key}"\n' for key in KEYS))
    rig.actuator()
    keyboard = rig.keyboard(tells_releases=True)
    keyboard.shows("nobody operates", "switches  lamp0 off")
    node, lit = rig.node("many"), dict[str, bool]()
    odometry = node.publisher("odom", Odometry)
    node.every(1 / 100)(lambda: odometry.publish(Odometry.zero()))

    for key in KEYS:
        node.subscription(f"lamp{key}", Bool, lambda lamp, key=key: lit.update({key: lamp.message.data}))
    typed = iter(KEYS * TIMES)

    def press() -> None:
        if key := next(typed, ""):
            keyboard.key(key)
            keyboard.key(key, "release")
        elif lit == dict.fromkeys(KEYS, True):
            node.stop()

    node.every(1 / 30)(press)
    node.spin(30.0)
    assert lit == dict.fromkeys(KEYS, True), "each was pressed an odd number of times"
