"""Every layer's sentence, as a person would read it."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.control.robot import FORWARD, REST, Robot

from zteleop.control.cap import CapSettings, Strain
from zteleop.control.explain import layers
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Differential
from zteleop.control.mux import Source
from zteleop.control.proof import NEVER
from zteleop.control.report import status
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.snapshot import snapshot
from zteleop.messages import Confirmed, Pwm, Twist

TANK = DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)})


def says(robot: Robot, confirmed: Confirmed = "", age: float = 0.0) -> dict[str, str]:
    step = robot.step()
    told = layers(snapshot(robot.drive, step, robot.now), robot.chip(step, confirmed, age))
    return {layer.name: layer.says for layer in told}


def test_at_rest_every_layer_says_so_from_the_operator_to_the_wheels() -> None:
    assert list(says(Robot()).items()) == [
        ("operator", "nobody operates"),
        ("gate", "refuses nobody"),
        ("mux", "nobody drives"),
        ("rest", "idle: nobody drives"),
        ("cap", "3 m/s: nobody drives"),
        ("limiter", "nothing to limit"),
        ("wheels", "throttle 1510 us = 370 ticks, steering 1530 us = 375 ticks"),
    ]


def test_a_twist_that_passes_as_asked() -> None:
    robot = Robot()
    robot.hold(Twist.planar(0.5, 0.25), 0.5)
    said = says(robot)
    assert said["operator"] == "keyboard 0001 operates, acted 0.1 s ago and asks for +0.50 m/s +0.25 rad/s"
    assert said["mux"] == "keyboard drives with priority 90"
    assert said["rest"] == "free to move"
    assert said["limiter"] == "passes it on as asked"
    assert re.fullmatch(r"throttle 1598 us = 392 ticks, steering \d+ us = \d+ ticks", said["wheels"])


def test_ticks_are_told_as_ticks() -> None:
    robot = Robot()
    robot.hold(Pwm(390, 400), 0.5)
    said = says(robot)
    assert said["operator"].endswith("asks for steering 390, throttle 400 ticks")
    assert said["wheels"] == "throttle 1632 us = 400 ticks, steering 1591 us = 390 ticks"
    assert said["limiter"] == "passes it on as asked"


def test_of_ticks_beyond_a_channel_its_end_is_said() -> None:
    robot = Robot()
    robot.hold(Pwm(9999, 390), 2.0)
    assert "steering ends at 460 ticks" in says(robot)["limiter"]
    robot.hold(Pwm(375, 300), 2.0)
    assert "ends at" not in says(robot)["limiter"]
    robot.hold(Pwm(9999, 370), 2.0)
    assert "steering ends at 460 ticks" in says(robot)["limiter"], "also while it stands"


@pytest.mark.parametrize("command", [Twist.planar(2.0), Pwm(375, 480)])
def test_what_still_accelerates_names_the_acceleration(command: Twist | Pwm) -> None:
    robot = Robot()
    robot.hold(command, 0.1)
    assert re.fullmatch(
        r"makes it \+0\.\d\d m/s \+0\.00 rad/s: speed changes by 3 m/s\^2", says(robot)["limiter"]
    )


@pytest.mark.parametrize("command", [Twist.planar(0.0, 0.5), Pwm(300, 370)])
def test_a_car_that_stands_does_not_turn_whatever_its_front_wheels_do(command: Twist | Pwm) -> None:
    robot = Robot()
    robot.hold(command, 0.3)
    said = "makes it +0.00 m/s +0.00 rad/s: a car that stands only turns its front wheels"
    assert says(robot)["limiter"] == (said if isinstance(command, Twist) else "passes it on as asked")


def test_a_car_that_slows_down_to_turn_on_the_spot_is_not_said_to_stand() -> None:
    robot = Robot()
    robot.hold(Twist.planar(2.0), 1.5)
    robot.hold(Twist.planar(0.0, 0.5), 0.1)
    assert "stands" not in says(robot)["limiter"]


def test_what_no_wheels_do_is_not_passed_on() -> None:
    robot, twist = Robot(), Twist.planar(0.5)
    twist.linear.y = 0.4
    robot.hold(twist, 0.5)
    words = "linear.y 0.4; a robot on wheels obeys linear.x and angular.z"
    assert says(robot)["limiter"] == f"makes it +0.50 m/s +0.00 rad/s: {words}"


def test_a_source_that_may_move_nothing_is_told_so_and_when_that_is() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, max_speed=0.0001)}))
    robot.hold(Twist.planar(2.0), 0.5, source="nav")
    words = "nav may move nothing here, as while zteleop calibrate runs"
    assert says(robot)["limiter"].endswith(words)
    assert says(robot)["cap"].endswith(words)


def test_a_source_that_may_not_drive_so_fast_names_its_cap() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, max_speed=0.4)}))
    robot.hold(Twist.planar(2.0), 0.5, source="nav")
    assert says(robot)["limiter"] == "makes it +0.40 m/s +0.00 rad/s: nav may drive 0.4 m/s here"
    assert says(robot)["cap"] == "0.4 of 3 m/s: nav may drive no faster here"


def test_a_vehicle_that_can_do_no_more_says_so_whoever_asks() -> None:
    robot = Robot()
    robot.hold(Twist.planar(9.0), 2.0)
    assert says(robot)["limiter"] == "makes it +3.00 m/s +0.00 rad/s: it does 3 m/s at most"


def test_a_good_link_is_told_with_its_age() -> None:
    robot = Robot()
    robot.wait(1.0)
    robot.hold(FORWARD, 1.0, age=0.062)
    assert says(robot)["cap"] == "3 m/s: commands of keyboard are up to 62 ms old"


def test_a_late_link_is_told_with_the_speed_it_leaves() -> None:
    robot = Robot()
    robot.wait(1.0)
    robot.hold(Twist.planar(3.0), 2.0, age=0.24)
    said = says(robot)
    words = "commands of keyboard are up to 240 ms old, and it must stop as soon as on a good link"
    assert said["cap"] == f"2.5 of 3 m/s: {words}"
    assert said["limiter"] == "makes it +2.50 m/s +0.00 rad/s: it may do 2.5 m/s now"


def test_a_stopping_distance_is_named() -> None:
    robot = Robot(DriveSettings(cap=CapSettings(stopping_distance=2.0)))
    robot.wait(1.0)
    robot.hold(FORWARD, 1.0, age=0.24)
    words = "commands of keyboard are up to 240 ms old, and it must stop within 2 m"
    assert says(robot)["cap"] == f"1.53 of 3 m/s: {words}"


def test_a_strain_is_told_even_at_rest() -> None:
    robot = Robot()
    robot.drive.movement.cap.bear(Strain(0.5, "the Pi is hot"))
    assert says(robot)["cap"] == "1.5 of 3 m/s: the Pi is hot"
    robot.hold(Twist.planar(3.0), 2.0)
    assert says(robot)["cap"] == "1.5 of 3 m/s: the Pi is hot"
    assert says(robot)["limiter"].endswith(": it may do 1.5 m/s now")


def test_a_sender_without_proof_is_told_as_one() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, trust="arrival")}))
    for command in (REST, FORWARD):
        robot.drive.receive("nav", command, None, robot.now)
        robot.wait(0.04)
    words = "commands of nav cannot prove their age, and it must stop as soon as on a good link"
    assert says(robot)["cap"] == f"2.25 of 3 m/s: {words}"


def test_a_throttle_obeyed_for_a_share_of_the_time_says_so() -> None:
    robot = Robot(DriveSettings(limits=Limits(pulse_duty=0.5, pulse_duty_period=0.5)))
    robot.hold(FORWARD, 0.5)
    while robot.now % 0.5 < 0.3:
        robot.hold(FORWARD, 0.05)
    assert "the throttle is obeyed 50% of the time" in says(robot)["limiter"]


def test_wheels_at_their_lock_turn_no_tighter() -> None:
    robot = Robot()
    robot.hold(Twist.planar(0.5, 3.0), 0.5)
    assert says(robot)["limiter"].endswith("it turns no tighter")


def test_what_no_bound_explains_is_the_wheels_own() -> None:
    robot = Robot(TANK)
    robot.hold(Twist.planar(1.0, 5.0), 2.0)
    assert says(robot)["limiter"].endswith(": the wheels can do no better")


def test_refusals_are_told_with_how_often_and_since_when_and_then_forgotten() -> None:
    robot = Robot()
    for _ in range(3):
        robot.drive.receive("web", FORWARD, None, robot.now)
        robot.wait(0.5)
    gate = says(robot)["gate"]
    assert gate.startswith("refuses web: it carries no proof; ")
    assert gate.endswith(" (3 times in 1.5 s, last 0.5 s ago)")
    robot.now += 1.0
    gate = says(robot)["gate"]
    assert gate.startswith("refuses nobody; lately refused web: it carries no proof; ")
    assert gate.endswith(" (3 times in 2.5 s, last 1.5 s ago)")
    robot.wait(10.0)
    assert says(robot)["gate"] == "refuses nobody"


def test_who_is_refused_is_called_as_everywhere_else() -> None:
    robot = Robot()
    robot.drive.admission.hold("chip", "fault", "the chip is silent", robot.now)
    robot.say(FORWARD)
    assert says(robot)["gate"].startswith("refuses keyboard 0001: the robot is kept at rest")


def test_a_reason_to_rest_is_told_with_its_age() -> None:
    robot = Robot()
    robot.drive.admission.hold("chip", "fault", "the chip is silent", robot.now)
    robot.wait(2.0)
    assert says(robot)["rest"] == "fault for 2.0 s: the chip is silent"
    robot.stop(7)
    rest = says(robot)["rest"]
    assert rest.startswith("fault for 2.0 s: the chip is silent; stopped for 0.0 s: stopped by ann")


def test_how_long_a_reason_from_before_the_start_lasts_nobody_knows() -> None:
    robot = Robot()
    robot.drive.admission.hold("stop", "stopped", "stopped by ann", NEVER)
    robot.wait(2.0)
    assert says(robot)["rest"] == "stopped since before its start: stopped by ann"


def test_who_waits_behind_the_one_who_drives_is_named() -> None:
    robot = Robot()
    robot.say(FORWARD, "a", "keyboard")
    robot.say(FORWARD, "b", "program")
    robot.say(FORWARD, "c", "web")
    assert says(robot)["mux"] == "web drives with priority 100; keyboard 0001, program 0002 wait"
    robot.wait(0.4)
    assert says(robot)["mux"] == "program drives with priority 50"


def test_after_letting_go_and_after_a_silence_the_reason_is_told() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.wait(0.4)
    assert says(robot)["rest"].startswith("link lost: keyboard 0001 has been silent for 0.")
    robot.say(REST)
    assert says(robot)["rest"] == "idle: nobody drives"


numbers = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, -0.0, 5e-324, 1e-310, 1.7e308, -1.7e308]),
)
int16 = st.integers(-(2**15), 2**15 - 1)
commands = st.one_of(st.builds(Twist.planar, numbers, numbers), st.builds(Pwm, int16, int16))


@given(st.lists(commands, min_size=1, max_size=3), st.booleans())
def test_any_command_is_explained_in_finite_numbers(wanted: list[Twist | Pwm], tank: bool) -> None:
    robot = Robot(TANK if tank else None)
    for command in wanted:
        robot.say(command)
        robot.wait(0.04)
        for text in says(robot).values():
            assert text
            assert not re.search(r"\b(nan|inf)\b", text), text


@given(commands)
def test_explaining_changes_nothing(command: Twist | Pwm) -> None:
    one, other = Robot(), Robot()
    for robot in (one, other):
        robot.say(command)
        robot.wait(0.04)
    says(one)
    other.step()
    assert one.wait(0.04) == other.wait(0.04)


@pytest.mark.parametrize(
    ("confirmed", "words"),
    [
        ("read", "neutral read back from the chip"),
        ("cut", "its outputs are cut"),
        ("", "not confirmed by the chip: cut its power"),
    ],
)
def test_how_a_stop_is_known_to_have_reached_the_wheels_is_told(confirmed: Confirmed, words: str) -> None:
    robot = Robot()
    assert words not in says(robot, confirmed)["wheels"]
    robot.stop(7)
    assert says(robot, confirmed)["wheels"].endswith(f" ticks; {words}")


def test_pulses_that_the_chip_took_long_ago_are_told_as_such() -> None:
    assert says(Robot(), age=1.2)["wheels"].endswith("; which the chip took 1.2 s ago, and nothing since")


def test_a_speed_that_somebody_set_is_told_also_at_rest_and_what_it_makes_of_a_wish() -> None:
    robot = Robot()
    robot.drive.limits = Limits(speed=0.3)
    assert says(robot)["cap"] == "0.3 of 3 m/s: limits.speed is set to 0.3 m/s"
    robot.hold(FORWARD, 2.0)
    assert says(robot)["limiter"].endswith(": limits.speed is set to 0.3 m/s")


def test_limits_that_somebody_has_narrowed_are_named_at_rest_and_where_they_bind() -> None:
    robot = Robot()
    robot.drive.limits = Limits(speed=3.0, turn=0.1, pulse_duty=0.5)
    assert says(robot)["limiter"] == "nothing to limit; set narrower: limits.turn 0.1, limits.pulse_duty 0.5"
    robot.hold(Twist.planar(0.5, 1.0), 2.0)
    told = says(robot)["limiter"]
    assert ": limits.turn is 0.1 rad/s; " in told
    assert told.endswith("(set narrower: limits.pulse_duty 0.5)")


def test_a_tank_that_turns_on_the_spot_is_told_what_bounds_it() -> None:
    robot = Robot(TANK)
    robot.drive.limits = Limits(turn=0.5)
    robot.hold(Twist.planar(0.0, 2.0), 2.0)
    assert says(robot)["limiter"] == "makes it +0.00 m/s +0.50 rad/s: limits.turn is 0.5 rad/s"


@pytest.mark.parametrize("command", [Twist.planar(2.0, 0.5), Pwm(400, 400)], ids=["twist", "ticks"])
def test_a_bound_of_the_yaw_rate_slows_a_car_on_its_curve_and_is_named(command: Twist | Pwm) -> None:
    robot = Robot()
    robot.drive.limits = Limits(turn=0.1)
    robot.hold(command, 3.0)
    assert re.fullmatch(
        r"makes it \+0\.\d\d m/s [+-]0\.10 rad/s: limits\.turn is 0\.1 rad/s", says(robot)["limiter"]
    )
    told = status(robot.drive, robot.step(), robot.chip(robot.step()), robot.now)
    assert told.slowed == "limits.turn is 0.1 rad/s"
    assert 0 < told.max_speed < 0.5
    assert abs(told.applied.angular.z) == pytest.approx(0.1, abs=0.001)


def test_a_motor_that_is_asked_for_too_little_to_turn_is_named() -> None:
    robot = Robot()
    robot.hold(Twist.planar(0.05), 0.5)
    said = says(robot)["wheels"]
    assert "throttle is in its motor's dead zone, and does not turn it yet" in said
    assert "steering is in" not in said
    robot.hold(Twist.planar(0.5), 0.5)
    assert "dead zone" not in says(robot)["wheels"]
    robot.hold(REST, 1.0)
    assert "dead zone" not in says(robot)["wheels"]
