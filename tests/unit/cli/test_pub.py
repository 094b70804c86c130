import argparse
from typing import Any

import pytest
from unit.nodes.fakes import Node, Said

from zteleop.bus.publisher import moves
from zteleop.cli import pub
from zteleop.control.drive import DriveSettings
from zteleop.control.mixer import Differential
from zteleop.control.report import describe
from zteleop.control.servo import Servo
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
    Vehicle,
)

CAR = describe(DriveSettings(), 4.08)
TANK = describe(
    DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)
FORWARD = Twist.planar(0.5)


def say(
    message: Message, times: int | None, ticks: int, vehicle: Vehicle | None = CAR, sender: str = "ff"
) -> list[Any]:
    """Return what is said within so many ticks, ended by Ctrl-C."""
    node, said = Node(), Said("cmd_vel", sender)
    node.robot_heard.vehicle = vehicle

    def spin() -> None:
        for _ in range(ticks):
            node.timers[0.1]()
            if node.stopped:
                return
        raise KeyboardInterrupt

    node.spin = spin
    try:
        pub._say(node, said, message, 10.0, times)
    except KeyboardInterrupt:
        assert times is None
    return said.messages


@pytest.mark.parametrize("times", [1, 3])
def test_it_says_it_so_many_times(times: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert say(FORWARD, times, 10) == [FORWARD] * times
    assert capsys.readouterr().out.startswith("publishing #1: Twist(linear=")


@pytest.mark.parametrize(
    "message",
    [
        FORWARD,
        TwistStamped(Header.zero(), FORWARD),
        Pwm(390, 400),
        Int16MultiArray(MultiArrayLayout.zero(), [390, 400]),
    ],
    ids=lambda message: type(message).__name__,
)
def test_a_repeated_motion_ends_with_the_vehicles_own_neutral(message: Message) -> None:
    *said, last = say(message, None, 5)
    assert said == [message] * 5
    assert type(last) is type(message)
    assert not moves(last, CAR)


@pytest.mark.parametrize("vehicle", [None, TANK])
def test_pulses_of_an_unknown_neutral_end_with_nothing_that_moves(vehicle: Vehicle | None) -> None:
    """0 ticks are no rest: they are as far back and to the right as the servos go."""
    assert say(Pwm(390, 400), None, 3, vehicle) == [Pwm(390, 400)] * 3


def test_what_is_no_command_ends_with_nothing() -> None:
    assert say(String("hello"), None, 3, sender="") == [String("hello")] * 3


@pytest.mark.parametrize(
    ("text", "values"),
    [("{linear: {x: 0.2}}", {"linear": {"x": 0.2}}), ("{}", {}), ("", None), ("[1, 2]", [1, 2])],
)
def test_values_are_yaml(text: str, values: object) -> None:
    assert pub._yaml(text) == values


@pytest.mark.parametrize("text", ["{linear: {x: 0.2}", "a: b: c", "!!python/name:os.system", "2024-13-45"])
def test_what_is_no_yaml_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(MessageError) as error:
        pub._yaml(text)
    assert str(error.value).startswith(f"expected YAML such as '{{linear: {{x: 0.2}}}}', found {text!r}: ")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(("text", "rate"), [("20", 20.0), ("0.5", 0.5), ("1000", 1000.0)])
def test_a_rate_is_a_number(text: str, rate: float) -> None:
    assert pub._rate_hz(text) == rate


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "1001"])
def test_a_rate_out_of_range_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="a rate is more than 0 and at most 1000 Hz"):
        pub._rate_hz(text)


@pytest.mark.parametrize("times", ["0", "-3"])
def test_a_count_that_never_comes_is_refused(times: str, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    pub.add_arguments(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["archangel/cmd_vel", "Twist", "-t", times])


@pytest.mark.parametrize(
    "text", ["!!timestamp x", "!!int ''", "!!bool x", "[" * 2000, "2001-99-99", "{[1]: 2}"]
)
def test_what_is_no_yaml_is_said_however_it_fails(text: str) -> None:
    with pytest.raises(MessageError, match="expected YAML such as"):
        pub._yaml(text)
