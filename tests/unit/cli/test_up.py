import os
import shutil
import sys
from pathlib import Path

import pytest

from zteleop.cli import up
from zteleop.errors import ConfigError
from zteleop.machine.launch import Program

PATH = Path("/etc/zteleop/config.toml")
ZTELEOP = (sys.executable, "-m", "zteleop")


@pytest.mark.parametrize(
    ("words", "command", "ends_first"),
    [
        (
            "actuator -l tcp/[::]:7447",
            [*ZTELEOP, "actuator", "--config", str(PATH), "-l", "tcp/[::]:7447", "--with-parent"],
            True,
        ),
        ("sim --config other.toml", [*ZTELEOP, "sim", "--config", "other.toml", "--with-parent"], False),
        ("topic echo odom", [*ZTELEOP, "topic", "echo", "--config", str(PATH), "odom"], False),
        ("python3 'my program.py'", ["python3", "my program.py"], False),
        ("./follow", ["./follow"], False),
        ("interface list", [*ZTELEOP, "interface", "list"], False),
    ],
)
def test_an_entry_is_a_verb_with_the_same_settings_or_any_program(
    words: str, command: list[str], ends_first: bool
) -> None:
    assert up.program("x", words, PATH) == Program(command, ends_first)


@pytest.mark.parametrize(
    ("words", "refusal"),
    [
        ("", "launch.x: expected a command"),
        ("echo 'odom", "launch.x: no closing quotation in"),
        ("keyboard --drive hold", "launch.x: zteleop keyboard wants a terminal of its own"),
        ("actuatr", "no program 'actuatr', and no verb of zteleop; did you mean actuator?"),
    ],
)
def test_an_entry_that_cannot_be_started_is_refused(words: str, refusal: str) -> None:
    with pytest.raises(ConfigError, match=refusal):
        up.program("x", words, PATH)


def test_each_mistake_of_a_file_is_told_with_its_place(tmp_path: Path) -> None:
    file = tmp_path / "config.toml"
    file.write_text('[launch]\nrobot = "actuatr"\nworld = "sim"\nx = ""\n')
    with pytest.raises(ConfigError) as refusal:
        up.programs_of({"robot": "actuatr", "world": "sim", "x": ""}, file)
    first, second = str(refusal.value).splitlines()
    assert first.startswith(f"{file}:2:1: launch.robot: no program 'actuatr'")
    assert second.startswith(f"{file}:4:1: launch.x: expected a command")


@pytest.mark.parametrize("words", ["./follow", "python3 follow.py", "run follow.py --robot abe", "/no/such"])
def test_a_program_that_is_not_there_is_told_before_it_is_started(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "config.toml"
    file.write_text(f'[launch]\nmine = "{words}"\n')
    with pytest.raises(ConfigError, match=f"config.toml:2:1: launch.mine: no .*, seen from {tmp_path}: "):
        up.programs_of({"mine": words}, file)
    (tmp_path / "follow.py").write_text("")
    (tmp_path / "follow").write_text("")
    (tmp_path / "follow").chmod(0o755)
    if words != "/no/such":
        assert list(up.programs_of({"mine": words}, file)) == ["mine"]


def test_a_unit_starts_the_same_and_an_actuators_is_watched() -> None:
    text = up.unit("robot", up.program("robot", "actuator", PATH))
    assert text.startswith("# /etc/systemd/system/zteleop-robot.service\n[Unit]\n")
    assert f"ExecStart={sys.executable} -m zteleop actuator --config {PATH}\n" in text
    assert "WatchdogSec=2\n" in text
    assert "--with-parent" not in text, "systemd gives it no input that lasts"
    assert f"WorkingDirectory={os.getcwd()}\n" in text
    own = up.unit("own", up.program("own", "python ../own.py", PATH))
    assert f"ExecStart={shutil.which('python')} ../own.py\n" in own, "systemd looks in no PATH of a shell"
    odd = up.unit("odd", up.program("odd", "python 100%.py $HOME", PATH))
    assert "ExecStart=" + f"{shutil.which('python')} 100%%.py '$$HOME'\n" in odd, "systemd fills in nothing"
    assert "WatchdogSec" not in up.unit("world", up.program("world", "sim", PATH))


def test_each_line_stands_behind_its_name(capsys: pytest.CaptureFixture[str]) -> None:
    tell = up.Teller(["robot", "sim"], color=False)
    tell("robot", "obeys")
    tell("sim", "\x1b[2Jmoves")
    assert capsys.readouterr().out == "robot | obeys\nsim   | \\u001b[2Jmoves\n"
    up.Teller(["robot"], color=True)("robot", "obeys")
    assert capsys.readouterr().out == "\x1b[36mrobot |\x1b[0m obeys\n"
