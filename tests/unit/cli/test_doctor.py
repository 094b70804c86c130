import errno
import os
import re
import socket
import termios
import time
from contextlib import nullcontext
from importlib import metadata
from pathlib import Path

import pytest
from unit.bus.fakes import Session

from zteleop.bus import codec
from zteleop.bus.lane import trial
from zteleop.bus.presence import Endpoint, Member
from zteleop.bus.session import Reply
from zteleop.cli import _checkup_bus, _checkup_machine, doctor
from zteleop.cli._checkup import CHECKS
from zteleop.cli._patient import Finding, Patient
from zteleop.cli._run import run_verb
from zteleop.config import Config, parse
from zteleop.errors import BusError
from zteleop.machine import health, leftovers, realtime
from zteleop.machine.leftovers import Running
from zteleop.messages import GetTimeResponse, Time

CAR = Patient(Config(), "", None)
REAL = Patient(parse(b"driver = 'pca9685'\n[drivers.pca9685]\nbus = 7\n"), "", None)


@pytest.fixture
def heard(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the robots that are on the bus."""
    found: list[str] = []
    monkeypatch.setattr(_checkup_bus, "open_session", lambda bus, settle: nullcontext(Session()))
    monkeypatch.setattr(_checkup_bus.presence, "robots", lambda session: found)
    monkeypatch.setattr(_checkup_bus.presence, "endpoints", lambda session: [])
    return found


@pytest.mark.parametrize(
    ("patient", "gone", "good"), [(CAR, "msgspec", False), (CAR, "smbus2", None), (REAL, "smbus2", False)]
)
def test_a_package_that_is_missing_is_named(
    monkeypatch: pytest.MonkeyPatch, patient: Patient, gone: str, good: bool | None
) -> None:
    good_, words = CHECKS["packages"](CAR)
    assert good_
    assert re.match(
        r"zteleop 0\.\S+, eclipse-zenoh 1\.\S+, msgspec \S+, pyyaml \S+, smbus2 [^,]+$", words, re.I
    )
    version = metadata.version

    def look(name: str) -> str:
        if name == gone:
            raise metadata.PackageNotFoundError
        return version(name)

    monkeypatch.setattr(metadata, "version", look)
    assert CHECKS["packages"](patient) == Finding(good, f"missing: {gone}; pip install them")


def test_a_config_file_that_is_wrong_hinders_and_the_rest_is_looked_at() -> None:
    assert CHECKS["config"](CAR).good
    assert CHECKS["config"](CAR._replace(wrong="config.toml:1:1: x: no such setting")) == (
        False,
        "config.toml:1:1: x: no such setting",
    )


@pytest.mark.parametrize(
    ("patient", "there", "mine", "good", "words"),
    [
        (REAL, True, True, True, "/dev/i2c-7 can be used"),
        (REAL, True, False, False, "usermod -aG i2c"),
        (REAL, False, False, False, "/dev/i2c-7 not found; is I2C enabled?"),
        (
            CAR,
            False,
            False,
            None,
            "do_i2c 0); only a real chip needs it",
        ),
        (CAR, True, False, None, "only a real chip needs it"),
    ],
)
def test_i2c_hinders_only_who_needs_it(
    monkeypatch: pytest.MonkeyPatch, patient: Patient, there: bool, mine: bool, good: bool | None, words: str
) -> None:
    monkeypatch.setattr(os.path, "exists", lambda path: there)
    monkeypatch.setattr(os, "access", lambda path, mode: mine)
    found = CHECKS["i2c"](patient)
    assert found.good is good
    assert words in found.words


@pytest.mark.parametrize(
    ("kind", "at_terminal", "good"), [("xterm", True, True), ("dumb", True, False), ("xterm", False, None)]
)
def test_a_terminal_that_draws_nothing_hinders(
    monkeypatch: pytest.MonkeyPatch, kind: str, at_terminal: bool, good: bool | None
) -> None:
    monkeypatch.setenv("TERM", kind)
    ours, theirs = os.openpty()
    termios.tcsetwinsize(theirs, (31, 117))
    finding = CHECKS["terminal"](CAR._replace(terminal=theirs if at_terminal else None))
    os.close(ours)
    os.close(theirs)
    assert finding.good is good
    assert ("117 x 31" in finding.words) is (good is True), "not what a pipe is taken for"


def test_a_clock_that_was_never_set_hinders(monkeypatch: pytest.MonkeyPatch) -> None:
    assert CHECKS["clock"](CAR).good
    monkeypatch.setattr(_checkup_machine, "BUILT", 9999)
    good, words = CHECKS["clock"](CAR)
    assert good is False
    assert "sudo timedatectl set-ntp true" in words


def test_a_port_that_another_has_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as other:
        other.bind(("", 0))
        other.listen()
        monkeypatch.setattr(_checkup_bus, "PORT", other.getsockname()[1])
        good, words = CHECKS["port"](CAR)
    assert good is None
    assert words.endswith("/tcp: Address already in use; a robot here may have it, another goes on without")
    assert CHECKS["port"](CAR).good


@pytest.mark.parametrize(
    ("comes_back", "good", "words"),
    [
        (lambda: True, True, "hears what it says"),
        (lambda: False, False, "nothing comes back: robots are not found by themselves; say -e tcp/pi.local"),
        (
            lambda: (_ for _ in ()).throw(OSError(errno.ENETUNREACH, "Network is unreachable")),
            False,
            "Network is unreachable: robots are not found",
        ),
    ],
)
def test_multicast_that_does_not_work_hinders(
    monkeypatch: pytest.MonkeyPatch, comes_back: object, good: bool, words: str
) -> None:
    def hears() -> bool:
        found = comes_back()  # type: ignore[operator]
        return found if isinstance(found, bool) else next(found)

    monkeypatch.setattr(trial, "hears_itself", hears)
    monkeypatch.setattr(_checkup_bus.networks, "is_in_none", lambda: False)
    found = CHECKS["multicast"](CAR)
    assert found.good is good
    assert words in found.words


def test_multicast_that_is_switched_off_is_worth_knowing() -> None:
    assert CHECKS["multicast"](Patient(parse(b"[bus]\nmulticast = false\n"), "", None)).good is None


def test_a_machine_in_no_network_is_worth_knowing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_checkup_bus.networks, "is_in_none", lambda: True)
    words = "this machine is in no network; its own programs and robots find each other"
    assert CHECKS["multicast"](CAR) == Finding(None, words)


def test_a_group_that_nobody_speaks_to_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trial, "send_to_group", lambda mouth, data, numbers: None)
    assert not trial.hears_itself(0.01)


def test_a_robot_that_is_meant_and_not_heard_is_worth_knowing(heard: list[str]) -> None:
    robots, meant = CHECKS["robots"], CAR._replace(settings=Config(robot="abe"))
    assert robots(CAR) == (None, "no actuator is heard here; zteleop demo starts one")
    assert robots(meant) == (None, "abe is not heard, no actuator is heard here; is its actuator on?")
    heard.append("zoe")
    assert robots(CAR) == (True, "heard here: zoe")
    assert robots(meant).good is None
    heard.append("abe")
    assert robots(meant).good


def test_who_disagree_about_a_type_hinder(heard: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    there = [
        Endpoint("abe", kind, node, "pi-7", "acme_msgs/msg/Soil", "soil", digest)
        for kind, node, digest in (("pub", "nose", "11"), ("sub", "ear", "22"))
    ]
    monkeypatch.setattr(_checkup_bus.presence, "endpoints", lambda session: there)
    good, words = CHECKS["robots"](CAR)
    assert good is False
    assert words.startswith("/abe/soil: nose on pi-7 says acme_msgs/msg/Soil 11; ear on pi-7 hears 22 alone")


@pytest.mark.parametrize("kind", [BusError, ModuleNotFoundError])
def test_a_bus_that_cannot_be_joined_hinders(monkeypatch: pytest.MonkeyPatch, kind: type[Exception]) -> None:
    def refuse(bus: object, settle: bool) -> None:
        raise kind("no such thing")

    monkeypatch.setattr(_checkup_bus, "open_session", refuse)
    assert CHECKS["robots"](CAR) == (False, "no such thing")


def test_each_check_is_a_line_and_what_hinders_is_counted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    checks = {"wheel": lambda patient: Finding(True, "round"), "cat": lambda patient: Finding(None, "asleep")}
    monkeypatch.setattr(doctor, "CHECKS", checks)
    assert run_verb("doctor", "say", []) == 0
    assert capsys.readouterr().out == "good   wheel      round\n-      cat        asleep\n\nnothing hinders\n"
    checks["key"] = lambda patient: Finding(False, f"none for {patient.settings.robot}")
    assert run_verb("doctor", "say", ["--robot", "abe"]) == 1
    assert capsys.readouterr().out.endswith("WRONG  key        none for abe\n\n1 thing to mend\n")
    checks["door"] = lambda patient: Finding(False, "shut")
    assert run_verb("doctor", "say", []) == 1
    assert capsys.readouterr().out.endswith("\n\n2 things to mend\n")


def test_a_typo_in_the_config_file_ends_no_examination(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / "config.toml").write_text("robt = 'abe'\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(doctor, "CHECKS", {"config": CHECKS["config"]})
    assert run_verb("doctor", "say", []) == 1
    said = (
        "WRONG  config     config.toml:1:1: robt: no such setting; did you mean robot?\n\n1 thing to mend\n"
    )
    assert capsys.readouterr() == (said, "")


class Clockwork(Session):
    """Nodes that are so many seconds ahead, and one that does not answer."""

    def __init__(self, **ahead: float | None) -> None:
        super().__init__()
        self.ahead = ahead

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        ahead = self.ahead[key.split("/")[-2]]
        if ahead is None:
            return None
        now = time.time() + ahead
        stamp = Time(int(now), int(now % 1 * 1e9))
        return Reply(codec.encode(GetTimeResponse(stamp)), codec.encoding_of(GetTimeResponse), False)


@pytest.mark.parametrize(
    ("ahead", "good", "words"),
    [
        ({}, None, "no node here tells what time it has"),
        ({"deaf": None}, None, "no node here tells what time it has"),
        ({"arm": 0.1, "leg": -0.2}, True, "2 nodes, each within 0.5 s of this machine's clock"),
        ({"arm": 0.1, "deaf": None}, True, "1 node, each within 0.5 s of this machine's clock"),
        ({"arm": 0.1, "leg": 7.4}, None, "/abe/leg is 7.4 s ahead of this machine's clock, and so are its"),
        ({"arm": -3600.0, "leg": 7.4}, None, "/abe/arm is 3600.0 s behind this machine's clock"),
    ],
)
def test_a_node_whose_clock_is_another_is_named(
    monkeypatch: pytest.MonkeyPatch, ahead: dict[str, float | None], good: bool | None, words: str
) -> None:
    members = [Member("abe", node, "pi-7") for node in ahead]
    monkeypatch.setattr(_checkup_bus, "open_session", lambda bus, settle: nullcontext(Clockwork(**ahead)))
    monkeypatch.setattr(_checkup_bus.presence, "with_parameters", lambda session: members)
    found = CHECKS["clocks"](CAR)
    assert found.good is good
    assert found.words.startswith(words)


@pytest.mark.parametrize(
    ("alarm", "heat", "throttled", "good", "words"),
    [
        (0, 51_234, "0", True, "good, 51 C"),
        (1, 51_234, "50005", False, "the Pi's supply is too low (undervoltage); use a better one"),
        (0, 86_000, "0", False, "the Pi is hotter than 85 C; give it air"),
        (
            *(0, 51_234, "90000", None),
            "good now; since its start its supply was too low, it was hot; a better supply, or more air",
        ),
    ],
)
def test_a_supply_that_is_too_low_hinders(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    alarm: int,
    heat: int,
    throttled: str,
    good: bool | None,
    words: str,
) -> None:
    monkeypatch.setattr(_checkup_machine, "SYS", tmp_path)
    assert CHECKS["supply"](CAR).good is None, "no Pi"
    for name, text in {
        "class/hwmon/hwmon0/name": "rpi_volt",
        "class/hwmon/hwmon0/in0_lcrit_alarm": alarm,
        "class/thermal/thermal_zone0/type": "cpu-thermal",
        "class/thermal/thermal_zone0/temp": heat,
        health.THROTTLED: throttled,
    }.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f"{text}\n")
    assert CHECKS["supply"](CAR) == Finding(good, words)


@pytest.mark.parametrize(
    ("found", "good", "words"),
    [
        (None, None, "nobody can tell which processes of zteleop run here: there is no ps"),
        ([], True, "no other of zteleop runs here"),
        ([Running(7, "sim", "01:02", True)], True, "sim (7): each at a terminal"),
        (
            [Running(7, "sim", "01:02", False), Running(8, "actuator", "01:02", True, frozen=True)],
            *(False, "actuator (8): stopped, and holds what it has: kill -CONT NUMBER lets it go on"),
        ),
        (
            [Running(7, "sim", "01:02", True), Running(8, "actuator", "2-03:04:05", False)],
            *(None, "actuator (8, for 2-03:04:05): without a terminal; where no service started one, kill"),
        ),
    ],
)
def test_a_process_that_was_left_is_named(
    monkeypatch: pytest.MonkeyPatch, found: list[Running] | None, good: bool | None, words: str
) -> None:
    monkeypatch.setattr(leftovers, "running", lambda: found)
    finding = CHECKS["processes"](CAR)
    assert finding.good is good
    assert finding.words.startswith(words)


@pytest.mark.parametrize(("driver", "good"), [("pca9685", False), ("simulated", None)])
def test_privileges_that_are_missing_hinder_a_real_robot(
    monkeypatch: pytest.MonkeyPatch, driver: str, good: bool | None
) -> None:
    patient, missing = REAL if driver == "pca9685" else CAR, list[str]()
    monkeypatch.setattr(realtime, "try_out", lambda priority, oom_score: missing)
    assert _checkup_machine.privileges(patient) == (True, "real-time priority, locked memory, low OOM score")
    missing += [realtime.LOCKED, realtime.SURVIVAL]
    assert _checkup_machine.privileges(patient).good is good
    assert _checkup_machine.privileges(patient).words.startswith("no locked memory, low OOM score: ")
