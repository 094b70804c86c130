import errno
import os
import re
import socket
import termios
from contextlib import nullcontext
from importlib import metadata
from pathlib import Path

import pytest
from unit.bus.fakes import Session

from zteleop.bus.lane import trial
from zteleop.bus.presence import Endpoint
from zteleop.cli import _checkup, doctor
from zteleop.cli._checkup import CHECKS, Finding, Patient
from zteleop.cli._run import run_verb
from zteleop.config import Config, parse
from zteleop.errors import BusError
from zteleop.machine import realtime

CAR = Patient(Config(), "", None)
REAL = Patient(parse(b"driver = 'pca9685'\n[drivers.pca9685]\nbus = 7\n"), "", None)


@pytest.fixture
def heard(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the robots that are on the bus."""
    found: list[str] = []
    monkeypatch.setattr(_checkup, "open_session", lambda bus, settle: nullcontext(Session()))
    monkeypatch.setattr(_checkup.presence, "robots", lambda session: found)
    monkeypatch.setattr(_checkup.presence, "endpoints", lambda session: [])
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
        (CAR, False, False, None, "/dev/i2c-1 is not there, or not yours to use; only a real chip needs it"),
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
    monkeypatch.setattr(_checkup, "BUILT", 9999)
    good, words = CHECKS["clock"](CAR)
    assert good is False
    assert "sudo timedatectl set-ntp true" in words


def test_a_port_that_another_has_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as other:
        other.bind(("", 0))
        other.listen()
        monkeypatch.setattr(_checkup, "PORT", other.getsockname()[1])
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
    monkeypatch.setattr(_checkup.networks, "is_in_none", lambda: False)
    found = CHECKS["multicast"](CAR)
    assert found.good is good
    assert words in found.words


def test_multicast_that_is_switched_off_is_worth_knowing() -> None:
    assert CHECKS["multicast"](Patient(parse(b"[bus]\nmulticast = false\n"), "", None)).good is None


def test_a_machine_in_no_network_is_worth_knowing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_checkup.networks, "is_in_none", lambda: True)
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
    monkeypatch.setattr(_checkup.presence, "endpoints", lambda session: there)
    good, words = CHECKS["robots"](CAR)
    assert good is False
    assert words.startswith("/abe/soil: nose on pi-7 says acme_msgs/msg/Soil 11; ear on pi-7 hears 22 alone")


@pytest.mark.parametrize("kind", [BusError, ModuleNotFoundError])
def test_a_bus_that_cannot_be_joined_hinders(monkeypatch: pytest.MonkeyPatch, kind: type[Exception]) -> None:
    def refuse(bus: object, settle: bool) -> None:
        raise kind("no such thing")

    monkeypatch.setattr(_checkup, "open_session", refuse)
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


@pytest.mark.parametrize(("driver", "good"), [("pca9685", False), ("simulated", None)])
def test_privileges_that_are_missing_hinder_a_real_robot(
    monkeypatch: pytest.MonkeyPatch, driver: str, good: bool | None
) -> None:
    patient, missing = REAL if driver == "pca9685" else CAR, list[str]()
    monkeypatch.setattr(realtime, "try_out", lambda priority, oom_score: missing)
    assert _checkup.privileges(patient) == (True, "real-time priority, locked memory, low OOM score")
    missing += [realtime.LOCKED, realtime.SURVIVAL]
    assert _checkup.privileges(patient).good is good
    assert _checkup.privileges(patient).words.startswith("no locked memory, low OOM score: ")
