import json
import os
import re
from pathlib import Path
from typing import Any

import pytest

from zteleop import config
from zteleop.config import Config, load, own_name, parse, places
from zteleop.control.mixer import Differential
from zteleop.drivers.pca9685 import Pca9685Settings
from zteleop.drivers.simulated import SimulatedSettings
from zteleop.errors import ConfigError

ROOT = Path(__file__).parents[2]
COMMENTED = re.compile(r"^# (?=\[|\w+ = )", re.MULTILINE)


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user without settings, in an empty folder."""
    for variable in ("XDG_CONFIG_HOME", "XDG_STATE_HOME"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def refusal(text: str | bytes) -> str:
    with pytest.raises(ConfigError) as error:
        parse(text.encode() if isinstance(text, str) else text)
    return str(error.value)


def test_without_a_file_everything_is_built_in(home: Path) -> None:
    assert load() == Config() == parse(b"")
    assert (Config().robot, Config().driver, Config().bus.mode) == (None, "simulated", "peer")


def test_the_repositorys_file_is_what_is_built_in() -> None:
    shipped, built_in = parse((ROOT / "config.toml").read_bytes()), Config()
    assert shipped.drive == built_in.drive
    assert shipped.speeds == built_in.speeds
    assert shipped.steps == built_in.steps
    assert shipped.bus == built_in.bus
    assert (shipped.robot, shipped.driver) == (built_in.robot, built_in.driver)
    assert shipped.driver_settings("simulated", "a") == built_in.driver_settings("simulated", "a")


def test_every_example_in_the_repositorys_file_can_be_obeyed() -> None:
    text = (ROOT / "config.toml").read_text()
    uncommented, count = COMMENTED.subn("", text)
    assert count >= 6
    settings = parse(uncommented.encode())
    assert settings.robot == "archangel"
    assert settings.bus.connect == ["tcp/pi.local:7447"]
    assert settings.drive.sources["nav"].silence == 0.5


def test_this_folder_comes_before_the_users(home: Path) -> None:
    users = write(home / ".config/zteleop/config.toml", 'robot = "users"')
    assert load().robot == "users"
    write(home / "here/config.toml", 'robot = "here"')
    assert load().robot == "here"
    assert load(users).robot == "users"


def test_the_users_folder_may_be_elsewhere(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(home / "elsewhere"))
    assert list(places()) == [Path("config.toml"), home / "elsewhere/zteleop/config.toml"]
    monkeypatch.setenv("XDG_CONFIG_HOME", "")
    assert list(places())[1] == home / ".config/zteleop/config.toml"


def test_every_mistake_is_told_with_its_file_line_and_column(home: Path) -> None:
    path = write(home / "x.toml", "speed = 1\n[drive.limits]\n  sped = 2\n  turn = -1")
    with pytest.raises(ConfigError) as error:
        load(path)
    first, *rest = str(error.value).splitlines()
    assert first.startswith(f"{path}:1:1: speed: no such setting; did you mean speeds?")
    assert rest == [
        f"{path}:3:3: drive.limits.sped: no such setting; did you mean speed?",
        f"{path}:4:3: drive.limits.turn: expected a number above 0 and at most 1000, found -1",
    ]


def test_no_more_mistakes_are_told_than_can_be_read() -> None:
    assert len(refusal("".join(f"x{n} = 1\n" for n in range(1000))).splitlines()) == config.MOST


def test_a_file_that_cannot_be_read_is_told(home: Path) -> None:
    with pytest.raises(ConfigError, match=r"^cannot read .*missing\.toml: No such file or directory$"):
        load(home / "missing.toml")
    with pytest.raises(ConfigError, match=r"^cannot read .*: Is a directory$"):
        load(home)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("speed = 1", "1:1: speed: no such setting; did you mean speeds?"),
        ("[drive.limits]\nspede = 1", "2:1: drive.limits.spede: no such setting; did you mean speed?"),
        ("[speeds]\nforward = 'fast'", "2:1: speeds.forward: expected a number from 0 to 100, found 'fast'"),
        ("[speeds]\nforward = 101", "2:1: speeds.forward: expected a number from 0 to 100, found 101"),
        ("[speeds]\nforward = nan", "2:1: speeds.forward: expected a number from 0 to 100, found nan"),
        ("[speeds]\nturn = inf", "2:1: speeds.turn: expected a number from 0 to 100, found inf"),
        (
            "steps.throttle_step_ticks = 0",
            "1:1: steps.throttle_step_ticks: expected a whole number from 1 to ",
        ),
        (
            "[drive.deadlines]\noperator = 5.1",
            "2:1: drive.deadlines.operator: expected a number above 0 and ",
        ),
        (
            "[drive.deadlines]\nmax_age = nan",
            "2:1: drive.deadlines.max_age: expected a number above 0 and at ",
        ),
        (
            "[drive.mixer]\nkind = 'boat'",
            "2:1: drive.mixer.kind: expected 'ackermann' or 'differential', found",
        ),
        ("[bus]\nmode = 'boss'", "2:1: bus.mode: expected 'client' or 'peer' or 'router', found 'boss'"),
        (
            "[bus]\nlisten = ['tcp/[::]:7447', '7447']",
            "2:1: bus.listen: expected an endpoint such as tcp/pi.local:7447 or tcp/[::]:7447, found '7447'",
        ),
        (
            "[bus]\nconnect = [1]",
            "2:1: bus.connect: expected an endpoint such as tcp/pi.local:7447 or tcp/[::]:7447, found 1",
        ),
        ("driver = 'pca'", "1:1: driver: no driver named 'pca'; did you mean pca9685?"),
        ("[drivers.pca]", "1:2: drivers: no driver named 'pca'; did you mean pca9685?"),
        ("[drivers.pca9685]\nport = 1", "2:1: drivers.pca9685.port: no such setting; known: address, "),
        ("robot = 'Arch Angel'", "1:1: robot: a robot's name is 1 to 63 of a-z, 0-9, _ and -, starting with"),
        (
            "[drive.sources.'a/*']\npriority = 1",
            "1:2: drive: a source is made of a-z, A-Z, 0-9, _ and -; found",
        ),
        (
            "[drive\na = 1",
            "1:7: not TOML: Expected ']' at the end of a table declaration; what else is wrong shows once",
        ),
        ("a = ", "1: not TOML: nothing stands behind =; "),
        ("a = b", "1:5: not TOML: Invalid value (text needs quotes); "),
        ('a = "b\nc = 1', "1:7: not TOML: a text ends with the quote that it begins with, found none; "),
        ("a = 'b", "1: not TOML: a text ends with the quote that it begins with, found none; "),
        ('a = "b', "1: not TOML: a text ends with the quote that it begins with, found none; "),
        ("a = \u201cb\u201d", "1:5: not TOML: a text stands in \" or ', found \u201c; "),
        ("a = True", "1:5: not TOML: yes and no are true and false, in small letters, found True; "),
        ("a = no", "1:5: not TOML: yes and no are true and false, in small letters, found no; "),
        ("a = 1\na = 2", "2: not TOML: a is written twice; what else is wrong shows once this is right"),
        ("[a]\nb = 1\nb = 2\nc = 3", "3:6: not TOML: b is written twice; "),
        ("[drive]\n[drive.limits]\n[drive.limits]", "3:14: not TOML: [drive.limits] is written twice; "),
        ("[speeds]\nforward = 2,5", "2:12: not TOML: a decimal point is a point, found a comma; "),
        ("[deadlines]\noperator = 2.0", "1:2: deadlines: no such setting; did you mean drive.deadlines?"),
        (b"a = '\xff'", " not TOML: "),
        ("a = " + "[" * 100_000, " not TOML: "),
        ("a = 1" + "0" * 5000, " not TOML: "),
    ],
    ids=lambda value: repr(value)[:50],
)
def test_a_mistake_is_refused_with_its_place_and_reason(text: str | bytes, words: str) -> None:
    assert refusal(text).removeprefix("settings:").startswith(words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[drive.servos.steering]\nchannel = 16",
            "2:1: drive.servos.steering.channel: expected a whole number from 0 to 15, found 16",
        ),
        ("[drive.servos.a]\nchanel = 1", "drive.servos.a.chanel: no such setting; did you mean channel?"),
        (
            "[drive.servos.good]\nchannel = 1\n[drive.servos.bad]\nchannel = 1\nmin_us = 'x'",
            "5:1: drive.servos.bad.min_us: expected us from 500",
        ),
        ("[drive.servos]\nsteering = 5", "2:1: drive.servos.steering: expected a table, found 5"),
        (
            "[drive.servos.a]\nchannel = 1\nmin_us = 600\nneutral_us = 550",
            "1:2: drive.servos.a: neutral_us must lie between min_us and max_us, found 600, 550, 2000",
        ),
        (
            "[drive.sources.nav]\npriority = 256",
            "2:1: drive.sources.nav.priority: expected a whole number from",
        ),
        ("[drivers]\nsimulated = 5", "2:1: drivers.simulated: expected a table, found 5"),
    ],
)
def test_a_mistake_in_a_table_of_names_is_told_by_its_name(text: str, words: str) -> None:
    assert words in refusal(text)
    assert "[...]" not in refusal(text)


@pytest.mark.parametrize(
    "text",
    [
        "robot = '[...]'",
        "'[...]' = 1",
        "driver = '[...]'",
        "[bus]\nmode = '[...]'",
        "[drive.servos.a]\n'[...]' = 1",
        "[drive.servos.'$.b']\nchannel = 16",
    ],
)
def test_a_mistake_that_looks_like_a_place_is_refused_all_the_same(text: str) -> None:
    assert refusal(text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[drive.mixer]\nkind = 'differential'",
            "1:2: drive.mixer: expected servos left, right, found steering, throttle, which are built in: "
            "write [drive.servos.left] and [drive.servos.right]",
        ),
        (
            "[drive.servos.throttle]\nchannel = 0",
            "1:2: drive.servos: expected servos steering, throttle, found throttle; "
            "what is written here replaces those built in",
        ),
        (
            "[drive.servos.throttle]\nchannel = 3\n[drive.servos.steering]\nchannel = 3",
            "1:2: drive.servos: each servo needs a channel of its own, found steering, throttle on channel 3",
        ),
    ],
)
def test_an_impossible_vehicle_is_refused(text: str, words: str) -> None:
    assert refusal(text) == f"settings:{words}"


def test_a_tank_is_two_servos() -> None:
    text = "[drive.mixer]\nkind = 'differential'\ntrack = 0.3\n"
    servos = "[drive.servos.left]\nchannel = 4\n[drive.servos.right]\nchannel = 5\n"
    drive = parse((text + servos).encode()).drive
    assert drive.mixer == Differential(track=0.3)
    assert {name: servo.channel for name, servo in drive.servos.items()} == {"left": 4, "right": 5}


def test_a_simulated_chip_is_named_after_its_robot_unless_its_path_is_set() -> None:
    paths = {Config().driver_settings("simulated", robot)["path"] for robot in ("abe", "zoe")}
    assert len(paths) == 2
    set_ = parse(b"[drivers.simulated]\npath = '/tmp/chip'\n")
    assert set_.driver_settings("simulated", "abe") == {"path": "/tmp/chip"}


def test_a_real_chips_settings_are_its_own() -> None:
    settings = parse(b"[drivers.pca9685]\nbus = 2\n")
    assert settings.driver_settings("pca9685", "abe") == {"bus": 2}
    assert Config().driver_settings("pca9685", "abe") == {}


def test_a_robot_gets_a_name_of_its_own_and_keeps_it(home: Path) -> None:
    name = own_name()
    assert re.fullmatch(r"car-[0-9a-f]{4}", name)
    assert own_name() == name
    assert (home / ".local/state/zteleop/robot").read_text() == f"{name}\n"


def test_two_robots_have_two_names(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = iter([b"\0\1", b"\0\2"])
    monkeypatch.setattr(config.os, "urandom", lambda size: next(numbers))
    names = []
    for folder in ("one", "two"):
        monkeypatch.setenv("XDG_STATE_HOME", str(home / folder))
        names.append(own_name())
    assert names == ["car-0001", "car-0002"]


def test_a_name_given_by_hand_is_kept(home: Path) -> None:
    write(home / ".local/state/zteleop/robot", "archangel\n")
    assert own_name() == "archangel"


@pytest.mark.parametrize("text", ["", "Arch Angel", "a/b", "\ud800"])
def test_a_kept_name_that_is_none_is_made_anew(home: Path, text: str) -> None:
    path = write(home / ".local/state/zteleop/robot", "")
    path.write_bytes(text.encode(errors="surrogatepass"))
    name = own_name()
    assert name.startswith("car-")
    assert own_name() == name


def test_where_no_name_can_be_kept_it_says_what_to_do(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(write(home / "file", "")))
    with pytest.raises(ConfigError, match=r"cannot keep a robot's name in .*: .*; say --robot NAME$"):
        own_name()


def test_a_kept_name_that_may_not_be_read_says_what_to_do(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*args: Any) -> None:
        raise PermissionError(13, "Permission denied")

    write(home / ".local/state/zteleop/robot", "archangel\n")
    monkeypatch.setattr(Path, "read_text", refuse)
    monkeypatch.setattr(Path, "write_text", refuse)
    with pytest.raises(ConfigError, match=r"cannot keep a robot's name in .*: Permission denied; say"):
        own_name()


def test_a_place_that_may_not_be_looked_into_is_passed_by(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A service's user with root's HOME."""
    stat = os.stat

    def refuse(path: Any, **options: Any) -> os.stat_result:
        if str(path).endswith("config.toml"):
            raise PermissionError(13, "Permission denied", str(path))
        return stat(path, **options)

    monkeypatch.setattr(os, "stat", refuse)
    assert load() == Config()


def test_a_file_that_is_there_but_may_not_be_read_is_told(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Passed by, a robot would drive with a calibration that is not its own."""

    def refuse(path: Path, mode: str) -> bytes:
        raise PermissionError(13, "Permission denied", str(path))

    write(home / "here/config.toml", "robot = 'archangel'")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(ConfigError, match=r"^cannot read config\.toml: Permission denied$"):
        load()


def test_the_file_at_the_top_shows_everything_that_can_be_set() -> None:
    text = COMMENTED.sub("", (ROOT / "config.toml").read_text())
    headings = " ".join(re.findall(r"^\[(.*)\]", text, re.MULTILINE))
    shown = {*re.findall(r"^(\w+) = ", text, re.MULTILINE), *re.findall(r"\w+", headings), "track"}
    tables = json.loads((ROOT / "schemas/config.json").read_text())["$defs"].values()
    drivers = (Pca9685Settings.__struct_fields__, SimulatedSettings.__struct_fields__)
    assert set().union(*(table["properties"] for table in tables), *drivers) <= shown


def test_a_file_without_end_is_not_read_to_it() -> None:
    with pytest.raises(ConfigError, match=r"^/dev/zero: expected at most 1048576 bytes of settings"):
        load(Path("/dev/zero"))


def test_half_of_a_file_is_no_config(home: Path) -> None:
    write(home / "here/config.toml", "robot = 'archangel'\n" + "#" * config.LONGEST + "\ndriver = 'pca9685'")
    with pytest.raises(ConfigError, match="expected at most"):
        load()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b'keymap = "donky"', "no keymap 'donky'; did you mean donkey?"),
        (b'[keys]\nf1 = "quti"', "key 'f1': no action 'quti'; did you mean quit?"),
    ],
)
def test_a_keymap_is_looked_up_when_the_file_is_read(text, words):
    with pytest.raises(ConfigError) as error:
        parse(text, "config.toml")
    assert words in str(error.value)


def test_what_settings_are_wrong_alone_is_told_beside_what_is_of_the_wrong_type() -> None:
    text = b"""
robot = "maker car"
keymap = "arows"
drivr = "pca9685"
journal = 3
[keys]
f1 = "stop robt"
[speeds]
forward = "fast"
"""
    with pytest.raises(ConfigError) as told:
        parse(text, "c.toml")
    lines = str(told.value).splitlines()
    assert [line.split(": ")[1] for line in lines] == [
        "robot",
        "keymap",
        "drivr",
        "journal",
        "keys",
        "speeds.forward",
    ]
    assert "no keymap 'arows'; did you mean arrows?" in lines[1]
    assert "no action 'stop robt'; did you mean" in lines[4]
