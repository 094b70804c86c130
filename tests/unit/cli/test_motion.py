import argparse
from math import radians
from types import SimpleNamespace
from typing import Any

import pytest
from msgspec.structs import replace

from zteleop.bus.subscription import Received
from zteleop.cli import circle, drive, square
from zteleop.cli._motion import Motion, announce, went
from zteleop.cli._options import measure
from zteleop.control.command import STEERS_ONLY
from zteleop.control.motion.course import Steady
from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.progress import Progress
from zteleop.control.motion.trail import Trail
from zteleop.errors import BusError, ConfigError
from zteleop.messages import Odometry, Pulse, Twist, Vehicle
from zteleop.testing import Clock, FakeNode


def trail(*poses: Pose2D) -> Trail:
    found = Trail()
    for number, pose in enumerate(poses):
        found.add(pose, number * 0.1)
    return found


def arc(radius: float, angle: float) -> Trail:
    """Return what is seen of an arc to the left, so far round, rad."""
    return trail(*(Pose2D().roll(radius * angle * part / 50, angle * part / 50) for part in range(51)))


@pytest.mark.parametrize(
    ("words", "twist"),
    [
        (["0.2m/s"], Twist.planar(0.2)),
        (["30deg/s"], Twist.planar(0.0, radians(30))),
        (["20cm/s", "-1rad/s"], Twist.planar(0.2, -1.0)),
        (["-1rad/s", "20cm/s"], Twist.planar(0.2, -1.0)),
        (["0.2", "0.5"], Twist.planar(0.2, 0.5)),
        ([" -0.2m/s"], Twist.planar(-0.2)),
    ],
)
def test_a_motion_is_typed_in_any_order_with_units_or_without(words: list[str], twist: Twist) -> None:
    made = drive.to_twist(words)
    assert (made.linear.x, made.angular.z) == pytest.approx((twist.linear.x, twist.angular.z))


@pytest.mark.parametrize(
    ("words", "wrong"),
    [
        (["fast"], "expected a speed such as 0.2m/s, found 'fast'"),
        (["2m"], "'2m', which is a length"),
        (["1m/s", "2m/s"], "expected a turning speed such as 30deg/s, found '2m/s', which is a speed"),
        (["1rad/s", "1deg/s"], "expected a speed such as 0.2m/s, found '1deg/s', which is a turning speed"),
        (["1", "2", "3"], "found '3' as well"),
    ],
)
def test_what_is_no_motion_is_said_to_be_none(words: list[str], wrong: str) -> None:
    with pytest.raises(ConfigError, match=wrong):
        drive.to_twist(words)


def test_a_measure_is_more_than_nothing() -> None:
    assert measure("length")("50cm") == 0.5
    for text in ("0", " -1m", "1s"):
        with pytest.raises(argparse.ArgumentTypeError):
            measure("length")(text)


@pytest.mark.parametrize(("text", "found"), [("2", 2.0), ("0.5", 0.5)])
def test_laps_are_a_number(text: str, found: float) -> None:
    assert circle.laps(text) == found


@pytest.mark.parametrize("text", ["0", "-1", "none", "nan", "inf", "1001"])
def test_what_is_no_number_of_laps_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="expected a number of laps"):
        circle.laps(text)


def test_a_circle_too_tight_for_a_car_is_said_with_what_it_can(car: Vehicle, tank: Vehicle) -> None:
    words = "expected a radius of 60cm or more, as bench steers no tighter, found 20cm"
    with pytest.raises(ConfigError, match=words):
        circle.check(car, 0.2, "bench")
    circle.check(car, 0.6, "bench")
    circle.check(tank, 0.2, "bench")


def test_what_came_of_it_is_told_in_its_own_measures() -> None:
    quarter = arc(0.5, radians(90))
    assert went(quarter) == "went 0.79 m and turned +90 deg in 5.0 s, on a circle of 0.50 m"
    assert went(trail(Pose2D(), Pose2D(0.2))) == "went 0.20 m and turned +0 deg in 0.1 s"
    assert went(trail(Pose2D(0.2), Pose2D())) == "went 0.20 m backwards and turned +0 deg in 0.1 s"
    aside = trail(Pose2D(heading=radians(90)), Pose2D(0.0, -0.3, radians(90)))
    assert went(aside).startswith("went 0.30 m backwards"), "by where it looks, not by the floor"
    spot = [Pose2D(heading=radians(5 * step)) for step in range(10)]
    assert went(trail(*spot)) == "went 0.00 m and turned +45 deg in 0.9 s"
    assert circle.told(quarter, 0.6).startswith("a radius of 0.50 m, as odometry saw it; 0.60 m were meant")
    assert circle.told(trail(Pose2D(), Pose2D(0.2)), 0.6).startswith("no circle")
    assert square.told(trail(Pose2D(), Pose2D(0.3, 0.4))).startswith("ended 0.50 m from where it began")


@pytest.mark.parametrize(
    ("changes", "by_sight", "words"),
    [
        ({}, True, ""),
        ({"seen": -2.0}, True, "nobody says any more where bench is"),
        ({"seen": -2.0, "stuck": True}, False, ""),
        ({"stuck": True}, True, "bench hardly moves; does something stand in its way?"),
        ({"heard": -2.0}, True, "bench says nothing any more"),
        ({"lost": "link lost: a moment"}, True, ""),
        ({"lost": "link lost: for long", "since": -2.0}, True, "link lost: for long"),
        ({"lost": "stopped: by ann", "taken": True}, True, "stopped: by ann"),
        ({"anew": True}, True, "where bench is was counted anew; say it again"),
        ({"anew": True}, False, ""),
        ({"obeyed": False}, True, ""),
        ({"obeyed": False, "refused": "it is too old"}, True, "it is too old"),
        ({"obeyed": False, "began": -5.0}, True, "it does not obey"),
    ],
)
def test_a_course_goes_on_for_as_long_as_it_is_obeyed_seen_and_makes_way(
    changes: dict[str, Any], by_sight: bool, words: str
) -> None:
    now, motion, seen = 100.0, Motion.__new__(Motion), {"obeyed": True, "taken": False} | changes
    motion._node = FakeNode(robot="bench")  # type: ignore[assignment]
    motion._outcome = SimpleNamespace(  # type: ignore[assignment]
        lost=seen.get("lost", ""),
        is_taken=seen["taken"],
        obeyed=seen["obeyed"],
        heard_at=now + seen.get("heard", 0.0),
    )
    motion._publisher = SimpleNamespace(refused=seen.get("refused", ""))  # type: ignore[assignment]
    motion._began, motion._lost = now + seen.get("began", 0.0), now + seen.get("since", 0.0)
    motion._seen, motion._trail = now + seen.get("seen", 0.0), arc(1.0, 1.0)
    motion._anew = seen.get("anew", False)
    motion._outcome.status = None
    motion._progress = SimpleNamespace(is_stuck=lambda trail, now: "stuck" in seen)  # type: ignore[assignment]
    assert motion._hindrance(now, by_sight) == words


@pytest.mark.parametrize(
    ("jump", "silent", "anew"), [(0.2, 0.05, False), (5.0, 0.05, True), (2.0, 0.9, False), (-5.0, 0.5, True)]
)
def test_odometry_that_begins_anew_is_noticed_and_is_no_way(
    clock: Clock, jump: float, silent: float, anew: bool
) -> None:
    motion = Motion.__new__(Motion)
    motion._pose, motion._seen, motion._trail, motion._anew = Pose2D(5.0), clock.time, Trail(), False
    clock.pass_by(silent)
    odom = Odometry.zero()
    odom.pose.pose.position.x = 5.0 + jump
    motion._see(Received(odom, "robot/bench/odom", None, clock.time))
    assert motion._anew is anew
    assert motion._pose == Pose2D(5.0 if anew else 5.0 + jump, 0.0, 0.0)


@pytest.mark.parametrize(
    ("obeyed", "refused", "told"), [(True, "", True), (False, "", True), (False, "keyboard drives", False)]
)
def test_what_another_drove_is_not_told_as_its_own(
    clock: Clock, capsys: pytest.CaptureFixture[str], obeyed: bool, refused: str, told: bool
) -> None:
    motion, _ = steady(clock, arc(1.0, 1.0), obeyed=obeyed, refused=refused)
    motion.drive(Steady(Twist.planar(0.5), 0.0), went)
    assert ("went " in capsys.readouterr().out) is told


def test_a_robot_that_stood_at_the_end_is_no_success(clock: Clock) -> None:
    motion, node = steady(clock, trail(Pose2D(), Pose2D(0.2), Pose2D(0.2)))
    with pytest.raises(BusError, match=r"bench stood for the last 2\.\d s of it; does something stand"):
        motion.drive(Steady(Twist.planar(0.5), 2.5), went)
    motion, node = steady(clock, trail(Pose2D(), Pose2D(0.2)))
    node.every(0.1)(lambda: motion._trail.add(Pose2D(0.2 + 0.5 * node.loop.clock.time), node.loop.clock.time))
    motion.drive(Steady(Twist.planar(0.5), 2.5), went)


@pytest.mark.parametrize("seconds", [0.3, 1.0, 2.5])
def test_a_robot_that_never_moved_is_no_success_however_short_it_was(
    clock: Clock, capsys: pytest.CaptureFixture[str], seconds: float
) -> None:
    motion, _ = steady(clock, trail(Pose2D(), Pose2D(0.001)))
    with pytest.raises(BusError, match=r"^bench did not move; does something stand"):
        motion.drive(Steady(Twist.planar(0.5), seconds), went)
    assert capsys.readouterr().out == "went nowhere\n"
    motion, _ = steady(clock, trail(Pose2D(), Pose2D(0.001)))
    motion.drive(Steady(Twist.planar(), seconds), went)


def test_what_is_said_is_announced_with_how_long(capsys: pytest.CaptureFixture[str]) -> None:
    for seconds, words in ((2.0, "for 2 s, or until Ctrl-C"), (None, "until Ctrl-C")):
        announce(FakeNode(robot="bench"), Twist.planar(0.5), seconds)  # type: ignore[arg-type]
        told = "says /bench/cmd_vel Twist '{linear: {x: 0.5}, angular: {z: 0}}', 20 times a second"
        assert capsys.readouterr().out == f"{told} {words}\n"


def steady(clock: Clock, seen: Trail, *, obeyed: bool = True, refused: str = "") -> tuple[Motion, FakeNode]:
    """Return a motion that has seen this, by a robot that obeys, or refuses."""
    motion, node = Motion.__new__(Motion), FakeNode(robot="bench", clock=clock)
    motion._node = node  # type: ignore[assignment]
    node.spin = lambda seconds=10.0: node.live(seconds)  # type: ignore[method-assign,assignment]
    motion._publisher = node.publisher("cmd_vel", Twist)  # type: ignore[assignment]
    motion._publisher.refused = refused  # type: ignore[misc]
    motion._outcome = SimpleNamespace(  # type: ignore[assignment]
        obeyed=obeyed,
        is_taken=False,
        status=None,
        lost="",
        heard_at=float("inf"),
        note=id,
        check=lambda: None,
    )
    motion._progress, motion._trail, motion._pose, motion._why = Progress(), seen, Pose2D(), ""
    motion._hindrance = lambda now, by_sight: ""  # type: ignore[method-assign]
    return motion, node


def test_whoever_goes_much_farther_than_the_course_is_goes_astray(clock: Clock) -> None:
    motion, _ = steady(clock, trail(*(Pose2D(step / 10) for step in range(60))))
    with pytest.raises(
        BusError, match=r"it drove 5\.9 m and is not there; does it steer the way it is told\?"
    ):
        motion.drive(Steady(Twist.planar(0.5), 2.0), went, most=5.0)
    motion, _ = steady(clock, trail(*(Pose2D(step / 10) for step in range(20))))
    assert motion._astray(5.0) == ""


def test_a_motor_in_its_dead_zone_is_why_it_stands(clock: Clock, car: Vehicle) -> None:
    motion, node = steady(clock, trail(Pose2D(), Pose2D(0.2)))
    channels = [replace(channel, dead_ticks=3) for channel in car.channels]
    node.hear_beat(vehicle=replace(car, channels=channels))
    neutral = next(channel.neutral_ticks for channel in channels if channel.name == "throttle")
    for off, words in (
        (3, "its throttle is in the motor's dead zone: ask for more"),
        (4, "something"),
        (0, "some"),
    ):
        pulse = Pulse("throttle", 0, 0.1, 4.08 * (neutral + off), neutral + off)
        motion._outcome.status = SimpleNamespace(  # type: ignore[assignment]
            pulses=[pulse], slowed="", max_speed=1.0
        )
        assert words in motion._hint(Twist.planar(0.1))
    motion._outcome.status = SimpleNamespace(  # type: ignore[assignment]
        pulses=[Pulse("throttle", 0, 0.1, 0.0, neutral + 3)], slowed="", max_speed=1.0
    )
    motion._outcome.status = SimpleNamespace(  # type: ignore[assignment]
        pulses=[Pulse("throttle", 0, 0.1, 0.0, neutral + 3)], slowed="limits.speed is set", max_speed=0.05
    )
    assert motion._hint(Twist.planar(1.0)).endswith("in the motor's dead zone, as limits.speed is set")
    motion._outcome.status = SimpleNamespace(  # type: ignore[assignment]
        pulses=[Pulse("throttle", 0, 0.1, 0.0, neutral + 3)], slowed="", max_speed=1.0
    )
    assert "ask for less turn" in motion._hint(Twist.planar(0.2, 30.0))
    assert motion._hint(Twist.planar(0.0, 1.0)) == STEERS_ONLY
    kept = "program may move nothing here"
    motion._outcome.status = SimpleNamespace(pulses=[], slowed=kept, max_speed=0.0001)  # type: ignore[assignment]
    assert motion._hint(Twist.planar(0.2)) == kept
