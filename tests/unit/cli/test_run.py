import argparse
import errno
import io
import os
from collections.abc import Callable
from contextlib import redirect_stdout
from types import SimpleNamespace

import pytest

from zteleop import cli
from zteleop.cli import _run
from zteleop.drivers import DRIVERS
from zteleop.errors import BusError, ConfigError, DeviceError, MessageError
from zteleop.machine import signals

Verb = Callable[..., int]


@pytest.fixture
def verb(monkeypatch: pytest.MonkeyPatch) -> Verb:
    """Run a verb that ends as told, and return the exit code."""
    undone: list[str] = []

    def run_(ending: object = None, arguments: list[str] | None = None) -> int:
        def act(options: argparse.Namespace) -> object:
            if isinstance(ending, BaseException):
                raise ending
            return ending() if callable(ending) else ending

        def add_arguments(parser: argparse.ArgumentParser) -> None:
            parser.add_argument("--speed", type=float)
            parser.add_argument("motion", nargs="*")

        module = SimpleNamespace(EXAMPLES=(), add_arguments=add_arguments, run=act)
        monkeypatch.setattr(_run, "import_module", {"zteleop.cli.fly": module}.__getitem__)
        monkeypatch.setattr(signals, "unwind", lambda: lambda: undone.append("undone"))
        monkeypatch.setitem(cli.VERBS, "fly", "fly a kite")
        try:
            return cli.main(["fly", *(arguments or [])])
        finally:
            assert undone == ["undone"]
            undone.clear()

    return run_


@pytest.mark.parametrize(("ending", "code"), [(None, 0), (0, 0), (1, 1), (7, 7)])
def test_what_a_verb_returns_is_the_exit_code(verb: Verb, ending: int | None, code: int) -> None:
    assert verb(ending) == code


def test_a_measure_with_a_minus_is_no_option(verb: Verb) -> None:
    assert verb(arguments=["--speed", "-0.5", "-20cm/s", "-.5m/s", "-30deg/s"]) == 0


@pytest.mark.parametrize("kind", [ConfigError, MessageError, BusError, DeviceError])
def test_an_error_on_purpose_is_one_sentence_and_1(
    verb: Verb, kind: type[Exception], capsys: pytest.CaptureFixture[str]
) -> None:
    assert verb(kind("expected wind, found none")) == 1
    assert capsys.readouterr() == ("", "zteleop fly: expected wind, found none\n")


def test_an_unexpected_error_is_one_sentence_that_owns_up(
    verb: Verb, capsys: pytest.CaptureFixture[str]
) -> None:
    assert verb(ZeroDivisionError("division by zero")) == 1
    words = "zteleop fly: ZeroDivisionError: division by zero (a bug; --debug shows where)\n"
    assert capsys.readouterr() == ("", words)


def test_a_limit_that_is_reached_is_nobodys_bug(verb: Verb, capsys: pytest.CaptureFixture[str]) -> None:
    assert verb(OSError(errno.ENOSPC, "No space left on device")) == 1
    assert capsys.readouterr() == ("", "zteleop fly: the disk is full; make room on it\n")


@pytest.mark.parametrize("error", [ConfigError("no wind"), KeyError("wind")])
def test_debug_shows_where(verb: Verb, error: Exception) -> None:
    with pytest.raises(type(error)) as found:
        verb(error, ["--debug"])
    assert found.value is error


def test_ctrl_c_is_130_and_silent(verb: Verb, capsys: pytest.CaptureFixture[str]) -> None:
    assert verb(KeyboardInterrupt()) == 130
    assert capsys.readouterr() == ("", "")


def test_a_signal_ends_with_its_own_code(verb: Verb) -> None:
    with pytest.raises(SystemExit) as ending:
        verb(SystemExit(143))
    assert ending.value.code == 143


def test_a_reader_that_left_is_no_error_to_talk_about(
    verb: Verb, deaf: io.TextIOWrapper, capfd: pytest.CaptureFixture[str]
) -> None:
    """What is still in the buffer counts too: at the end Python would complain of it, and exit with 120."""
    with redirect_stdout(deaf):
        assert verb(lambda: print("a kite")) == 1  # noqa: T201
    deaf.close()
    assert capfd.readouterr().err == ""


def test_a_unit_that_stands_alone_is_written_beside_its_number(
    verb: Verb, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        _run.run_verb("circle", "drive a circle", ["50", "cm"])
    assert "cm stands alone; write number and unit together, such as 50cm" in capsys.readouterr().err


@pytest.mark.parametrize(("name", "verb"), [("echo", "list"), ("param get", "node list")])
def test_who_names_nothing_is_told_where_the_names_are(
    name: str, verb: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ending:
        _run.run_verb(name, "do it", [])
    assert ending.value.code == 2
    assert f"zteleop {verb} shows those there are" in capsys.readouterr().err


def test_a_wrong_argument_is_a_usage_error(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ending:
        _run.run_verb("check", "check a config file", ["a", "b"])
    assert ending.value.code == 2
    assert "unrecognized arguments: b" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("verb", "typed", "words"),
    [
        ("pub", "cmd_vel Twist --rote 5", "no option --rote; did you mean --rate?"),
        ("pub", "cmd_vel Twist --rote=5", "no option --rote; did you mean --rate?"),
        ("keyboard", "--keymapp wasd", "no option --keymapp; did you mean --keymap?"),
        (
            "stop",
            "--reason x",
            "no option --reason; zteleop stop --help shows those there are",
        ),  # never --release
        ("echo", "odom --qos-depth 5", "no option --qos-depth: of QoS there is nothing to choose here"),
        ("list", "--no-daemon", "no option --no-daemon: there is no daemon; whoever is on the bus is asked"),
        (
            "list",
            "--include-hidden-topics",
            "no option --include-hidden-topics: all topics and nodes are shown as it is",
        ),
        ("pub", "cmd_vel Twist -p 3", "no option -p; zteleop pub --help shows those there are"),
        ("list", "--colour", "no option --colour; zteleop list --help shows those there are"),
        ("list", "-- --robot", "--robot stands behind --, where all is taken as it is; write it before that"),
        ("list", "a b", "unrecognized arguments: a b"),
        ("run", "", "the following arguments are required: FILE"),
        ("camera", "test --rate 61", "argument --rate: expected 1 to 60, found 61"),
        ("camera", "test --quality x", "argument --quality: expected 1 to 100, found x"),
        (
            "camera",
            "test --size 640",
            "argument --size: expected WIDTHxHEIGHT in pixels, such as 640x480, found '640'",
        ),
        (
            "demo",
            "--vehicle tnak",
            "argument --vehicle: expected car or tank or create3 or create3_full, found tnak; "
            "did you mean tank?",
        ),
        ("neutral", "--driver zebra", "argument --driver: expected {drivers}, found zebra"),
        ("keyboard", "--zebra wasd", "no option --zebra; zteleop keyboard --help shows those there are"),
    ],
)
def test_an_option_that_is_nearly_one_is_asked_about(
    capsys: pytest.CaptureFixture[str], verb: str, typed: str, words: str
) -> None:
    with pytest.raises(SystemExit) as ending:
        _run.run_verb(verb, "say something", typed.split())
    assert ending.value.code == 2
    words = words.format(drivers=" or ".join(DRIVERS))
    assert capsys.readouterr().err.endswith(f"zteleop {verb}: error: {words}\n")


def test_a_verb_that_is_there_runs(capsys: pytest.CaptureFixture[str], tmp_path: os.PathLike[str]) -> None:
    path = os.path.join(tmp_path, "config.toml")
    with open(path, "w") as file:
        file.write("speed = 1\n")
    assert _run.run_verb("check", "check a config file", [path]) == 1
    assert (
        capsys.readouterr().err
        == f"zteleop check: {path}:1:1: speed: no such setting; did you mean speeds?\n"
    )


def test_what_strangers_said_is_escaped_in_an_error(verb: Verb, capsys: pytest.CaptureFixture[str]) -> None:
    assert verb(BusError("stopped by \x1b[2J\u202e")) == 1
    assert capsys.readouterr().err == "zteleop fly: stopped by \\u001b[2J\\u202e\n"


def test_what_a_terminal_cannot_show_ends_nothing(verb: Verb, capsys: pytest.CaptureFixture[str]) -> None:
    out = io.TextIOWrapper(io.BytesIO(), "ascii")
    with redirect_stdout(out):
        assert verb(lambda: print("é\udcff")) == 0  # noqa: T201
    assert out.buffer.getvalue() == b"\\xe9\\udcff\n"  # type: ignore[attr-defined]
    assert capsys.readouterr().err == ""
