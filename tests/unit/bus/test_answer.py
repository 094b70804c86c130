import re

import pytest
from msgspec.structs import replace
from unit.bus.fakes import Ring, sample

from zteleop.bus import codec
from zteleop.bus.answer import ADVICE, LASTS, UNHEARD, Answer
from zteleop.bus.heard import Heard
from zteleop.bus.log import NodeLog
from zteleop.bus.subscription import Subscription
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Differential
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.messages import (
    Beat,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Pwm,
    Refusals,
    Refused,
    Twist,
    TwistStamped,
    Vector3,
    Vehicle,
)
from zteleop.testing import Clock

WORDS = "not now"
HOW = "suspended, or in a long handler"
TANK = DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)})


SLUGGISH = {**DONKEYCAR, "throttle": replace(DONKEYCAR["throttle"], dead_zone_us=22.0)}


class Sender:
    """A publisher of cmd_vel, what it hears of its robot, and what its log says."""

    def __init__(self, clock: Clock, is_program: bool = True) -> None:
        self.clock, self.beats, self.refusals = clock, Ring(), Ring()
        self.heard = Heard(inbox(self.beats, Beat), inbox(Ring(), Vehicle), inbox(self.refusals, Refusals))
        self.lines: list[str] = []
        log = NodeLog("nose", lambda log: None, self.lines.append)
        self.answer = Answer("ff", "cmd_vel", "archangel", self.heard, log, is_program=is_program)

    def refuse(self, why: str = WORDS, sender: str = "ff", rest: str = "", by: str = "") -> None:
        refused = Refused(sender, "program", why, by, 0.6)
        self.refusals.samples.append(sample(Refusals([refused], rest, 0)))

    def say(
        self, seconds: float = 0.0, beats: bool = True, moving: bool = True, listens: bool = True
    ) -> None:
        """Publish ten times a second."""
        for _ in range(round(seconds * 10) or 1):
            self.clock.pass_by(0.1)
            if beats:
                self.beats.samples.append(sample(Beat(1, self.clock.time, 0.0)))
            if listens:
                self.heard.listen()
            self.answer.heed(moving)

    def advise(self, message: Message, moving: bool) -> None:
        self.answer.advise(message, moving)

    @property
    def news(self) -> list[str]:
        lines, self.lines[:] = list(self.lines), []
        return lines


def inbox(ring: Ring, kind: type[Message]) -> Subscription:
    return Subscription(ring, codec.decoders([kind]), pytest.fail)


@pytest.fixture
def sender(clock: Clock) -> Sender:
    return Sender(clock)


def test_while_all_is_well_nothing_is_said(sender: Sender) -> None:
    sender.say(5.0)
    assert (sender.answer.refused, sender.news) == ("", [])


def test_a_refusal_is_said_once_in_the_robots_words(sender: Sender) -> None:
    for _ in range(10):
        sender.refuse()
        sender.say(0.2)
        assert sender.answer.refused == WORDS
    assert sender.news == ["nose: warning: cmd_vel is refused by robot archangel: not now"]


@pytest.mark.parametrize("why", Refusal)
def test_it_says_what_to_do(sender: Sender, why: str) -> None:
    sender.refuse(why)
    sender.say()
    (line,) = sender.news
    fact = why.partition("; ")[0]
    assert line.endswith(f": {fact}; {ADVICE[why]}" if why in ADVICE else f": {why}")
    assert why in ADVICE or ";" in why


def test_what_keeps_the_robot_at_rest_is_said_with_it(sender: Sender) -> None:
    sender.refuse(rest="stopped by ann")
    sender.say()
    assert sender.answer.refused == "not now (stopped by ann)"


def test_another_reason_is_said_too(sender: Sender) -> None:
    for why in ("one", "one", "two"):
        sender.refuse(why)
        sender.say()
    assert [line.rpartition(" ")[2] for line in sender.news] == ["one", "two"]


def test_what_another_sender_is_told_is_not_ours(sender: Sender) -> None:
    sender.refuse(sender="fe")
    sender.say()
    assert (sender.answer.refused, sender.news) == ("", [])


def test_when_the_robot_names_it_no_longer_it_counts_again(sender: Sender) -> None:
    sender.refuse()
    sender.say()
    sender.refuse(sender="fe")
    sender.say()
    assert sender.answer.refused == ""
    assert sender.news[1:] == ["nose: info: what is said on cmd_vel is no longer refused by robot archangel"]


def test_a_refusal_that_is_not_repeated_is_over(sender: Sender) -> None:
    sender.refuse()
    sender.say()
    sender.say(LASTS - 0.1)
    assert len(sender.news) == 1
    sender.say(0.3)
    assert "no longer refused" in sender.news[0]


def test_who_says_nothing_does_not_know(sender: Sender, clock: Clock) -> None:
    sender.refuse()
    sender.say()
    clock.pass_by(LASTS + 0.1)
    assert sender.answer.refused == ""
    assert len(sender.news) == 1


def test_a_robot_that_is_not_heard_is_missed_once_and_its_return_said(sender: Sender) -> None:
    sender.say(1.0)
    sender.say(UNHEARD - 0.1, beats=False)
    assert sender.news == []
    sender.say(5.0, beats=False)
    (line,) = sender.news
    assert line.startswith("nose: warning: robot archangel is not heard any more; what is said on cmd_vel")
    sender.say(2.0)
    assert sender.news == ["nose: info: robot archangel is heard"]


def test_a_robot_that_was_never_heard_is_missed(sender: Sender) -> None:
    sender.say(UNHEARD + 0.2, beats=False)
    assert "is not heard; what" in sender.news[0]


def test_who_asks_for_what_no_wheels_do_is_told(sender: Sender) -> None:
    sideways = Twist(Vector3(0.0, 0.5, 0.0), Vector3.zero())
    sender.advise(sideways, False)
    sender.advise(sideways, False)
    (line,) = sender.news
    assert line == (
        "nose: warning: what is said on cmd_vel moves nothing: "
        "a robot on wheels obeys linear.x and angular.z, and both are 0"
    )


@pytest.mark.parametrize(
    ("is_program", "advice"),
    [(True, "start this anew, or let_go() in a program"), (False, "let go of everything, and begin anew")],
)
@pytest.mark.parametrize("refusal", [Refusal.BEFORE_RELEASE, Refusal.HELD, Refusal.WAITED])
def test_who_is_refused_is_told_what_it_can_do(
    clock: Clock, is_program: bool, advice: str, refusal: Refusal
) -> None:
    sender = Sender(clock, is_program)
    sender.refuse(refusal)
    sender.say()
    (line,) = sender.news
    assert advice in line
    assert "pause for 2 s" not in line, "one advice is enough"
    assert line.count(";") == 1
    assert sender.answer.refused == refusal, "which is the robot's, for screens"


SIDEWAYS = Twist(Vector3(0.5, 0.4, 0.0), Vector3(-1.0, 0.0, 0.0))
FAST, TIGHT, BOTH = Twist.planar(30.0), Twist.planar(0.5, 2.0), Twist.planar(30.0, 100.0)
TOO_FAST = "30 m/s, and it does 3 at most"
TOO_TIGHT = "a circle of 0.25 m in radius, and 0.59 m is the tightest it drives"


@pytest.mark.parametrize(
    ("twist", "told"),
    [
        (FAST, [TOO_FAST]),
        (TwistStamped(Header.zero(), TIGHT), [TOO_TIGHT]),
        (BOTH, [TOO_FAST, TOO_TIGHT.replace("0.25", "0.30")]),
        (Twist.planar(-30.0), [TOO_FAST]),
        (Twist.planar(2.0, 3.3), []),
        (Twist.planar(float("inf")), []),
    ],
)
def test_a_program_that_asks_for_more_than_a_car_does_is_told_once_what_is_obeyed(
    sender: Sender, clock: Clock, twist: Twist | TwistStamped, told: list[str]
) -> None:
    sender.advise(twist, True)
    assert sender.news == [], "nobody knows yet what it drives"
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8)
    for _ in range(2):
        sender.advise(twist, True)
        clock.pass_by(60.0)  # when the log would tell it again
    expected = [f"nose: warning: what is said on cmd_vel is more than the robot does: {one}" for one in told]
    assert sender.news == expected


def test_who_turns_on_the_spot_faster_than_it_can_is_told(sender: Sender) -> None:
    sender.heard.vehicle = to_vehicle(TANK, 4.8)
    sender.advise(Twist.planar(0.0, -50.0), True)
    (line,) = sender.news
    assert line.endswith("more than the robot does: 50 rad/s, and it turns 10 at most")


@pytest.mark.parametrize(
    ("message", "told"),
    [
        (Twist.planar(0.02), "0.02 m/s is in its motor's dead zone; 0.14 m/s and more turns it"),
        (TwistStamped(Header.zero(), Twist.planar(-0.05)), "0.05 m/s is in its motor's dead zone; 0.12 m/s"),
        (Pwm(375, 373), "throttle 373 is in its motor's dead zone, 365 to 375"),
    ],
)
def test_a_program_that_asks_for_less_than_turns_a_motor_is_told_what_does(
    sender: Sender, message: Message, told: str
) -> None:
    sender.heard.vehicle = to_vehicle(DriveSettings(servos=SLUGGISH), 4.08)
    for _ in range(2):
        sender.advise(message, True)
    (line,) = sender.news
    assert f"what is said on cmd_vel moves nothing: {told}" in line
    sender.advise(Twist.planar(0.2), True)
    assert sender.news == []


def test_what_a_twist_asks_for_besides_is_told_once(sender: Sender) -> None:
    for _ in range(2):
        sender.advise(SIDEWAYS, True)
    (line,) = sender.news
    words = "linear.y 0.4 and angular.x -1; a robot on wheels obeys linear.x and angular.z"
    assert line == f"nose: warning: what is said on cmd_vel is more than the robot does: {words}"


def test_an_operator_who_holds_more_than_a_car_does_sees_it_on_the_screen(clock: Clock) -> None:
    sender = Sender(clock, is_program=False)
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8)
    sender.advise(BOTH, True)
    assert sender.news == []


@pytest.mark.parametrize(("is_program", "told"), [(True, 1), (False, 0)])
def test_a_program_that_turns_a_car_on_the_spot_is_told_once(
    clock: Clock, is_program: bool, told: int
) -> None:
    sender = Sender(clock, is_program)
    for twist in (Twist.planar(0.0, 0.5), Twist.planar(0.5, 0.5), Twist.planar(0.0, -0.5)):
        sender.advise(twist, True)  # while nobody knows what it drives
    assert sender.news == []
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8)
    sender.advise(Twist.planar(0.5, 0.5), True)
    assert sender.news == []
    sender.advise(Twist.planar(0.0, 0.5), True)
    clock.pass_by(60.0)  # when the log would tell it again
    sender.advise(TwistStamped(Header.zero(), Twist.planar(0.0, -0.5)), True)
    expected = (
        "nose: warning: what is said on cmd_vel turns front wheels and moves nothing: "
        "a car turns only while it drives; give linear.x as well as angular.z"
    )
    assert sender.news == [expected] * told


def test_ticks_beyond_the_ends_of_a_servo_are_told_with_what_is_obeyed(sender: Sender) -> None:
    sender.advise(Pwm(1500, 1600), True)
    assert sender.news == [], "nobody knows yet what it drives"
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.08)
    for inside in (Pwm(375, 400), Pwm(330, 490)):
        sender.advise(inside, True)
    assert sender.news == []
    sender.advise(Pwm(1500, 400), True)
    (line,) = sender.news
    words = "steering 1500 ticks is obeyed as 460, its end; a tick is 4.08 us"
    assert line.endswith(f"more than the robot does: {words}")
    sender.advise(Int16MultiArray(MultiArrayLayout.zero(), [1500, 0]), True)
    assert f"throttle 0 ticks is obeyed as 220, its end; {words}" in sender.news[0]


def test_a_tank_turns_on_the_spot(sender: Sender) -> None:
    sender.heard.vehicle = to_vehicle(TANK, 4.8)
    sender.advise(Twist.planar(0.0, 0.5), True)
    assert sender.news == []


def test_who_was_told_at_the_start_is_not_told_again(sender: Sender) -> None:
    sender.answer.miss()
    sender.say(3.0, beats=False)
    assert len(sender.news) == 1
    sender.say()
    assert "is heard" in sender.news[0]


def test_who_moves_nothing_misses_nobody(sender: Sender) -> None:
    sender.say(3.0, beats=False, moving=False)
    assert sender.news == []


def test_in_a_long_handler_nobody_is_missed_and_a_refusal_is_heard(sender: Sender) -> None:
    sender.say(1.0)
    sender.refuse()
    sender.say(3.0, beats=False, listens=False)
    assert [line.partition(" is ")[0] for line in sender.news] == [
        "nose: warning: cmd_vel",
        "nose: info: what",
    ]


def test_a_robot_that_is_gone_is_not_heard_and_refuses_nothing(sender: Sender) -> None:
    sender.refuse()
    sender.say()
    sender.say(UNHEARD + 0.2, beats=False)
    assert sender.answer.refused == "robot archangel is not heard"
    sender.refuse()
    sender.say()
    assert sum("is refused" in line for line in sender.news) == 2


def test_a_program_that_moves_the_robot_too_seldom_is_told_once(sender: Sender) -> None:
    for _ in range(10):
        sender.clock.pass_by(0.9)
        sender.say()
    (line,) = sender.news
    assert "cmd_vel is said every 1.0 s, which is too seldom: robot archangel rests in between" in line
    assert "publish 10 times a second or more" in line


def test_who_stood_still_is_told_so_and_blames_neither_the_robot_nor_its_own_pace(sender: Sender) -> None:
    sender.say(0.5)
    for _ in range(3):
        sender.clock.pass_by(UNHEARD + 0.5)
        sender.heard.awake_since = sender.clock.time
        sender.say(0.1, beats=False)
    assert sender.news == []
    sender.refuse()
    sender.say()
    (line,) = sender.news
    assert f"cmd_vel is refused by robot archangel, as this process stood still ({HOW}): {WORDS}" in line
    sender.refuse("another word")
    sender.say(LASTS)
    assert "stood still" in sender.news[0]
    sender.refuse("a third")
    sender.say()
    assert "stood still" not in sender.news[0], "long ago"


@pytest.mark.parametrize("gap", [0.1, 0.45, 10.0])
def test_a_stream_and_single_moves_are_no_slow_stream(sender: Sender, gap: float) -> None:
    for _ in range(10):
        sender.clock.pass_by(gap - 0.1)
        sender.say()
    assert sender.news == []


def test_who_only_steers_is_not_told_to_say_it_more_often(sender: Sender) -> None:
    for _ in range(10):
        sender.clock.pass_by(0.9)
        sender.beats.samples.append(sample(Beat(1, sender.clock.time, 0.0)))
        sender.heard.listen()
        sender.answer.heed(True, steers=True)
    assert sender.news == []


def test_who_lets_go_in_between_rests_on_purpose(sender: Sender) -> None:
    for _ in range(10):
        for moving in (True, False):
            sender.clock.pass_by(0.6)
            sender.say(moving=moving)
    assert sender.news == []


def test_a_program_that_was_told_of_a_turn_is_a_program_still(clock: Clock) -> None:
    sender = Sender(clock)
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8)
    for _ in range(2):
        sender.advise(Twist.planar(0.0, 0.5), True)
    sender.refuse(Refusal.HELD)
    sender.say()
    told, refused = sender.news
    assert "a car turns only while it drives" in told
    assert "let_go() in a program" in refused


@pytest.mark.parametrize("was_heard", [True, False])
def test_where_a_robot_is_said_is_no_help_once_it_was_heard(clock: Clock, was_heard: bool) -> None:
    sender = Sender(clock)
    sender.answer._hint = "; say where it is"
    if was_heard:
        sender.say(1.0)
    sender.say(3.0, beats=False)
    (line,) = sender.news
    assert line.endswith("; say where it is") is not was_heard


def test_who_drives_meanwhile_is_named(sender: Sender) -> None:
    sender.refuse(Refusal.HELD, by="keyboard 18d4")
    sender.say()
    words = "keyboard 18d4 drives this source; when that one is done, start this anew"
    assert f"refused by robot archangel: {words}" in sender.news[0]
    assert sender.answer.refused.startswith("keyboard 18d4 drives this source; let go")


def test_a_program_that_asks_for_more_than_its_robot_may_now_is_told_that(sender: Sender) -> None:
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8)
    sender.advise(Twist.planar(0.6), True)
    assert sender.news == []
    sender.heard.vehicle = to_vehicle(DriveSettings(), 4.8, allowed=Limits(speed=0.5))
    for _ in range(2):
        sender.advise(Twist.planar(0.6), True)
    (line,) = sender.news
    assert line.endswith("robot does: 0.6 m/s, and it does 0.5 at most: limits.speed is set to that")


def look(sender: Sender, seconds: float) -> list[str]:
    """Let the thread beside a program look for a while."""
    for _ in range(round(seconds / 0.1)):
        sender.clock.pass_by(0.1)
        sender.answer.look()
    return sender.news


def test_a_program_that_falls_silent_is_told_within_two_seconds_and_once(sender: Sender) -> None:
    sender.say(0.5)
    assert look(sender, 1.0) == []
    (line,) = look(sender, 5.0)
    assert re.search(r"nothing was said on cmd_vel for 1\.[23] s, so robot archangel rests; publish", line)
    sender.say(0.5)
    (again,) = look(sender, 3.0)
    assert "nothing was said on cmd_vel" in again, "it was heard meanwhile"


def test_who_rests_may_be_silent(sender: Sender) -> None:
    sender.say(0.5)
    sender.say(moving=False)
    assert look(sender, 5.0) == []


def test_who_is_refused_is_told_that_and_not_that_he_is_silent(sender: Sender) -> None:
    sender.refuse()
    sender.say()
    assert len(sender.news) == 1
    assert look(sender, 1.9) == []


def test_who_stood_still_while_he_was_refused_is_refused_still(sender: Sender) -> None:
    sender.refuse()
    sender.say()
    assert "refused" in sender.news[0]
    sender.clock.pass_by(9.0)
    sender.heard.awake_since = sender.clock.time
    sender.say(beats=True)
    assert not [line for line in sender.news if "no longer refused" in line]


def test_it_moves_while_motion_is_asked_for_and_not_refused(sender: Sender) -> None:
    assert not sender.answer.moves
    sender.say()
    assert sender.answer.moves
    sender.refuse()
    sender.say()
    assert not sender.answer.moves
    sender.say(LASTS + 0.2)
    sender.say(moving=False)
    assert not sender.answer.moves
