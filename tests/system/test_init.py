"""A first config file by five questions, from a terminal and from a pipe."""

from collections.abc import Iterator

import pytest
from rig import Rig


@pytest.fixture
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("init")) as bench:
        (bench.folder / "config.toml").unlink()
        yield bench


def test_five_questions_make_a_file_that_starts_a_robot(rig: Rig) -> None:
    terminal = rig.terminal("init")
    for question, answer in (
        ("what is the robot called? [car-", "archangel"),
        ("what is it: car or tank? [car]", "tonk"),
        ("expected car or tank, found 'tonk'; did you mean tank?", "tank"),
        ("which chip makes its pulses: pca9685, simulated or sysfs_pwm? [simulated]", ""),
        ("on which channels are left and right? [0 1]", "3 3"),
        ("expected two different channels from 0 to 15, such as 0 1, found '3 3'", "3, 4"),
        ("how many m between its wheels? [20cm]", "5kg"),
        ("expected a length such as 50cm, found '5kg'", "30m"),
        ("expected a length between 1cm and 10m, found 30m", "18cm"),
    ):
        terminal.shows(question)
        terminal.type(f"{answer}\r")
    assert terminal.ends() == 0
    terminal.shows("config.toml is written", "zteleop actuator   starts archangel")
    said = rig.result("check").stdout
    assert "robot    archangel" in said
    assert "vehicle  differential" in said
    assert "left     channel 3" in said
    robot = rig.run("actuator", "--no-multicast-scouting", "--listen", rig.endpoint)
    robot.says("archangel obeys")


def test_what_is_there_stays(rig: Rig) -> None:
    assert rig.result("init", "--yes").returncode == 0
    before = (rig.folder / "config.toml").read_text()
    again = rig.result("init", "--yes")
    assert (again.returncode, again.stdout) == (1, "")
    assert "config.toml is there already, and stays; zteleop check says what it makes" in again.stderr
    assert (rig.folder / "config.toml").read_text() == before


@pytest.mark.parametrize("key", ["\x03", "\x04"], ids=["Ctrl-C", "Ctrl-D"])
def test_who_leaves_half_way_has_written_nothing(rig: Rig, key: str) -> None:
    terminal = rig.terminal("init")
    terminal.shows("what is the robot called?")
    terminal.type("archangel\r")
    terminal.shows("what is it: car or tank?")
    terminal.type(key)
    assert terminal.ends() == (130 if key == "\x03" else 1)
    assert not (rig.folder / "config.toml").exists()


def test_a_file_that_cannot_be_written_is_said(rig: Rig) -> None:
    result = rig.result("init", "nowhere/robot.toml", "--yes")
    assert result.returncode == 1
    assert result.stderr == "zteleop init: cannot write nowhere/robot.toml: No such file or directory\n"
