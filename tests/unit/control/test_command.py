import pytest

from zteleop.control.command import neutral, to_command
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.errors import MessageError
from zteleop.messages import (
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Pwm,
    String,
    Twist,
    TwistStamped,
)

FORWARD = Twist.planar(0.5)


def ticks(*data: int) -> Int16MultiArray:
    return Int16MultiArray(MultiArrayLayout.zero(), list(data))


@pytest.mark.parametrize(
    ("message", "command"),
    [
        (FORWARD, FORWARD),
        (TwistStamped(Header.zero(), FORWARD), FORWARD),
        (Pwm(390, 400), Pwm(390, 400)),
        (ticks(390, 400), Pwm(390, 400)),
        (ticks(390, 400, 99), Pwm(390, 400)),
    ],
)
def test_each_type_of_command_is_a_twist_or_pulses(message: Message, command: Twist | Pwm) -> None:
    assert to_command(message) == command


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (ticks(), r"expected \[steering, throttle\], found \[\]"),
        (ticks(390), r"expected \[steering, throttle\], found \[390\]"),
        (String("go"), "a String commands nothing"),
    ],
)
def test_what_commands_nothing_is_refused_in_words(message: Message, words: str) -> None:
    with pytest.raises(MessageError, match=words):
        to_command(message)


@pytest.mark.parametrize(
    ("kind", "command"),
    [
        (Twist, Twist.zero()),
        (TwistStamped, TwistStamped.zero()),
        (Pwm, Pwm(375, 370)),
        (Int16MultiArray, ticks(375, 370)),
    ],
)
def test_each_type_of_command_has_a_neutral(kind: type[Message], command: Message) -> None:
    assert neutral(kind, to_vehicle(DriveSettings(), 4.08)) == command


def test_pulses_of_an_unknown_vehicle_have_none() -> None:
    assert neutral(Pwm, None) is None
    assert neutral(Twist, None) == Twist.zero()
