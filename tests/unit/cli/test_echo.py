import argparse

import pytest
import yaml
from unit.bus.fakes import put, sample

from zteleop.bus.names import Name
from zteleop.cli import echo
from zteleop.errors import MessageError
from zteleop.messages import Int16MultiArray, Message, Pwm, String, Twist
from zteleop.messages.message import zero_of

Capsys = pytest.CaptureFixture[str]


def parsed(*words: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    echo.add_arguments(parser)
    return parser.parse_args(["cmd_vel", *words])


def shown(capsys: Capsys, message: Message, *words: str) -> str:
    assert echo.Wanted(parsed(*words)).show(sample(message))
    out, err = capsys.readouterr()
    assert err == ""
    return out


def test_a_message_is_printed_as_yaml_that_can_be_read_back(capsys: Capsys) -> None:
    out = shown(capsys, Twist.planar(0.5))
    assert out.startswith("linear:\n  x: 0.5\n")
    assert out.endswith("---\n")
    (values, _) = yaml.safe_load_all(out)
    assert values["angular"] == {"x": 0.0, "y": 0.0, "z": 0.0}


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--json"], '{"linear":{"x":0.5,"y":0.0,"z":0.0},"angular":{"x":0.0,"y":0.0,"z":1.0}}\n'),
        (["--csv"], "0.5,0.0,0.0,0.0,0.0,1.0\n"),
        (["--csv", "--header", "--field", "linear.x"], "linear.x\n0.5\n"),
        (["--field", "linear.x"], "0.5\n---\n"),
        (["--field", "linear.x", "--field", "angular.z"], "linear.x: 0.5\nangular.z: 1.0\n---\n"),
        (["--field", "angular", "--flow-style"], "{x: 0.0, y: 0.0, z: 1.0}\n---\n"),
        (["--filter", "m.linear.x > 0.2", "--field", "linear.x"], "0.5\n---\n"),
        (["Twist", "--field", "linear.x"], "0.5\n---\n"),
    ],
)
def test_somebody_sees_the_part_and_the_form_that_was_asked_for(
    capsys: Capsys, words: list[str], text: str
) -> None:
    assert shown(capsys, Twist.planar(0.5, 1.0), *words) == text


def test_long_arrays_and_texts_are_cut_unless_somebody_wants_all(capsys: Capsys) -> None:
    array = zero_of(Int16MultiArray)
    array.data = list(range(4))
    assert "'...'" in shown(capsys, array, "--truncate-length", "2", "--flow-style")
    assert "[0, 1, 2, 3]" in shown(capsys, array, "-f", "--flow-style")
    assert "<sequence type: int16, length: 4>" in shown(capsys, array, "--no-arr")
    assert shown(capsys, String("three"), "--no-str", "--field", "data") == "<string length: <5>>\n---\n"


def test_raw_is_the_bytes_of_it_even_of_what_nobody_can_read(capsys: Capsys) -> None:
    assert echo.Wanted(parsed("--raw")).show(put(b"\x1b[2J", encoding="zenoh/bytes"))
    assert capsys.readouterr().out == "b'\\x1b[2J'\n---\n"


def test_what_is_not_wanted_is_not_shown_and_not_counted(capsys: Capsys) -> None:
    assert not echo.Wanted(parsed("--filter", "m.linear.x > 0.5")).show(sample(Twist.planar(0.5)))
    assert capsys.readouterr() == ("", "")


def test_a_type_without_what_is_asked_for_is_told_of_once(capsys: Capsys) -> None:
    wanted = echo.Wanted(parsed("--field", "linear.x"))
    for _ in range(3):
        assert not wanted.show(sample(Pwm(375, 370)))
    assert wanted.show(sample(Twist.planar(0.5)))
    out, err = capsys.readouterr()
    assert out == "0.5\n---\n"
    assert err.count("Invalid field 'linear.x'") == 1


@pytest.mark.parametrize(
    ("words", "refusal"),
    [
        (["--field", "linear.w"], "Invalid field 'linear.w'"),
        (["--filter", "m.linaer.x > 0"], "filter: Invalid field 'linaer"),
        (["Pwn"], "no message type 'Pwn'"),
        (["Pwm"], "not Pwm; say that type, or none"),
    ],
)
def test_what_no_message_of_the_topic_can_have_is_refused_before_any_comes(
    words: list[str], refusal: str
) -> None:
    with pytest.raises(MessageError, match=refusal):
        echo.Wanted(parsed(*words)).check(Name("abe", "cmd_vel"))


@pytest.mark.parametrize("text", ["__import__('os')", "m.x +", "lambda: 1"])
def test_a_filter_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(MessageError):
        echo.Wanted(parsed("--filter", text))


@pytest.mark.parametrize("text", ["nan", "0", "2 parsecs", ""])
def test_a_time_that_is_none_is_refused(text: str, capsys: Capsys) -> None:
    with pytest.raises(SystemExit):
        parsed("--timeout", text)
    assert "found" in capsys.readouterr().err


@pytest.mark.parametrize(("text", "seconds"), [("2", 2.0), ("500ms", 0.5), ("1min", 60.0)])
def test_a_time_may_have_a_unit(text: str, seconds: float) -> None:
    assert parsed("--timeout", text).timeout == seconds


@pytest.mark.parametrize("text", ["\x1b[2J", "\x9b2J", "\x07"])
@pytest.mark.parametrize("form", ["--json", "--csv", "--flow-style"])
def test_what_could_steer_a_terminal_is_escaped(text: str, form: str, capsys: Capsys) -> None:
    assert text[0] not in shown(capsys, String(text), form)


def test_what_cannot_be_read_is_said_on_stderr_escaped(capsys: Capsys) -> None:
    bad = put(b"\x00\x01", encoding="zenoh/bytes", key="robot/abe/\x1b[2J")
    assert not echo.Wanted(parsed()).show(bad)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("zteleop echo: robot/abe/\\u001b[2J: 2 bytes of 'zenoh/bytes', not JSON")


def test_what_is_nested_too_deeply_for_yaml_is_said_and_no_end(capsys: Capsys) -> None:
    deep = put(b"[" * 900 + b"]" * 900, encoding="application/json", key="robot/abe/odom")
    assert not echo.Wanted(parsed()).show(deep)
    assert "1800 bytes of 'application/json', nested too deeply to show" in capsys.readouterr().err


def test_a_stranger_who_thinks_of_new_types_fills_no_memory(capsys: Capsys) -> None:
    wanted = echo.Wanted(parsed("--json"))
    for number in range(1000):
        assert wanted.show(put(b"{}", encoding=f"application/json;x/msg/T{number}"))
    assert len(wanted._known) < 200
