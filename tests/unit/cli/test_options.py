import argparse
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from unit.bus.fakes import Session

from zteleop import config
from zteleop.bus import presence
from zteleop.bus.settings import BusSettings
from zteleop.cli import _options
from zteleop.config import Config
from zteleop.errors import ConfigError


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for variable in ("XDG_CONFIG_HOME", "XDG_STATE_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "user"))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def parse(*arguments: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    _options.add(parser)
    return parser.parse_args(arguments)


def session(*robots: str) -> Any:
    return Session([presence.node_key(robot, "actuator") for robot in robots])


def test_nothing_typed_changes_nothing() -> None:
    assert _options.load(parse()) == Config()


@pytest.mark.parametrize(
    ("arguments", "bus"),
    [
        (["-m", "client"], BusSettings(mode="client")),
        (["--mode", "router"], BusSettings(mode="router")),
        (["-e", "tcp/a:1", "--connect", "tcp/b:2"], BusSettings(connect=["tcp/a:1", "tcp/b:2"])),
        (["-l", "tcp/[::]:7447", "--listen", "tcp/c:3"], BusSettings(listen=["tcp/[::]:7447", "tcp/c:3"])),
        (["--no-multicast-scouting"], BusSettings(multicast=False)),
    ],
)
def test_what_is_typed_stands_above_the_file(home: Path, arguments: list[str], bus: BusSettings) -> None:
    (home / "config.toml").write_text("robot = 'archangel'\n")
    assert _options.load(parse(*arguments)) == Config(robot="archangel", bus=bus)


def test_what_is_not_typed_stays_as_in_the_file(home: Path) -> None:
    (home / "x.toml").write_text("robot = 'abe'\n[bus]\nmulticast = false\nconnect = ['tcp/a:1']\n")
    settings = _options.load(parse("--config", str(home / "x.toml"), "--robot", "zoe"))
    assert settings == Config(robot="zoe", bus=BusSettings(connect=["tcp/a:1"], multicast=False))


@pytest.mark.parametrize("arguments", [["--robot", "A b"], ["--robot", "*"], ["-m", "boss"]])
def test_what_cannot_be_obeyed_is_a_usage_error(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ending:
        parse(*arguments)
    assert ending.value.code == 2
    assert repr(arguments[1]) in capsys.readouterr().err


def test_the_robot_meant_is_the_one_named() -> None:
    assert _options.find_robot(session("abe", "bob"), Config(robot="zoe")) == "zoe"


def test_else_it_is_the_only_one_there() -> None:
    assert _options.find_robot(session("abe"), Config()) == "abe"


def test_else_it_is_this_machines_own() -> None:
    assert _options.find_robot(session(), Config()) == config.own_name()


def test_of_several_none_is_chosen() -> None:
    with pytest.raises(ConfigError, match=r"^2 robots are on the bus: abe, bob; say --robot NAME$"):
        _options.find_robot(session("bob", "abe"), Config())


@pytest.mark.parametrize(
    ("topic", "selected", "robot"),
    [
        ("archangel/odom", None, "archangel"),
        ("/archangel/odom", "zoe", "archangel"),
        ("odom", "zoe", "zoe"),
        ("odom", None, None),
        ("cmd_vel/web", None, None),
        ("*", "zoe", "zoe"),
    ],
)
def test_the_robot_of_a_topic_is_the_one_it_says(topic: str, selected: str | None, robot: str | None) -> None:
    assert _options.robot_of(topic, Config(robot=selected)) == robot


def test_a_topic_of_another_robot_than_was_typed_is_refused() -> None:
    words = "/abe/odom is a topic of abe, and --robot says bob; leave one of them out"
    with pytest.raises(ConfigError, match=words):
        _options.robot_of("/abe/odom", Config(robot="bob"), "bob")
    assert _options.robot_of("/abe/odom", Config(robot="bob")) == "abe", "whatever a file says"
    assert _options.robot_of("odom", Config(robot="bob"), "bob") == "bob"


def test_a_robot_that_cannot_be_chosen_leaves_the_bus(monkeypatch: pytest.MonkeyPatch) -> None:
    bus = session("abe", "bob")
    monkeypatch.setattr(_options, "open_session", lambda settings, settle, patient: bus)
    with pytest.raises(ConfigError, match="2 robots are on the bus"):
        _options.join("keyboard", Config())
    assert bus.closed


def test_only_without_a_name_it_settles_before_it_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    settles: list[bool] = []

    def open_session(settings: BusSettings, settle: bool, patient: bool) -> Session:
        assert not patient
        settles.append(settle)
        return session("abe")

    monkeypatch.setattr(_options, "open_session", open_session)
    for robot in (None, "abe"):
        with _options.join("keyboard", Config(robot=robot)) as node:
            assert node.robot == "abe"
    assert settles == [True, False]


@pytest.mark.parametrize("typed", [True, False])
def test_a_child_ends_when_its_parent_does(typed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    watched: dict[int, object] = {}
    loop = SimpleNamespace(watch=watched.__setitem__)
    node = SimpleNamespace(membership=SimpleNamespace(loop=loop), stop="stop")
    monkeypatch.setattr(_options.sys, "stdin", SimpleNamespace(fileno=lambda: 5))
    _options.end_with_parent(argparse.Namespace(with_parent=typed), node)
    assert watched == ({5: "stop"} if typed else {})


@pytest.mark.parametrize(
    ("text", "robots", "others"),
    [
        ('listen = ["tcp/[::]:7447"]', (["tcp/[::]:7447"], []), ([], ["tcp/127.0.0.1:7447"])),
        (
            'listen = ["tcp/0.0.0.0:1", "tcp/pi:2"]',
            (["tcp/0.0.0.0:1", "tcp/pi:2"], []),
            ([], ["tcp/127.0.0.1:1", "tcp/pi:2"]),
        ),
        ('listen = ["tcp/[::]:1"]\nconnect = ["tcp/a:2"]', (["tcp/[::]:1"], ["tcp/a:2"]), ([], ["tcp/a:2"])),
        ('mode = "router"\nlisten = ["tcp/[::]:1"]', (["tcp/[::]:1"], []), (["tcp/[::]:1"], [])),
    ],
)
def test_where_a_file_lets_its_robot_listen_everybody_else_connects(
    home: Path, text: str, robots: tuple[list[str], list[str]], others: tuple[list[str], list[str]]
) -> None:
    (home / "config.toml").write_text(f"[bus]\n{text}\n")
    robot, other = _options.load(parse(), listens=True).bus, _options.load(parse()).bus
    assert (robot.listen, robot.connect) == robots
    assert (other.listen, other.connect) == others
    typed = _options.load(parse("-l", "tcp/[::]:9", "-e", "tcp/b:3")).bus
    assert (typed.listen, typed.connect) == (["tcp/[::]:9"], ["tcp/b:3"])


def test_where_no_actuator_is_on_the_only_robot_that_nodes_are_here_for_is_meant(
    capsys: pytest.CaptureFixture[str],
) -> None:
    lonely = Session([presence.node_key("abe", "sim"), presence.node_key("abe", "keyboard")])
    assert _options.find_robot(lonely, Config()) == "abe"  # type: ignore[arg-type]
    assert capsys.readouterr().err == ""
    both = Session([presence.node_key(robot, "sim") for robot in ("abe", "zoe")])
    assert _options.find_robot(both, Config()).startswith("car-")  # type: ignore[arg-type]
    assert "no actuator is heard (there are nodes of abe, zoe)" in capsys.readouterr().err
