"""What deploy/ promises: the unit's keys, its command lines, the page's links, commands and settings."""

import argparse
import importlib
import re
import shlex
from pathlib import Path
from xml.etree import ElementTree

import pytest

from zteleop import config
from zteleop.cli import VERBS

DEPLOY = Path(__file__).parents[2] / "deploy"
PAGE = (DEPLOY / "README.md").read_text()
BINARY = "/opt/zteleop/bin/zteleop"
SETTINGS = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
LINKS = re.findall(r"\]\(([^)]+)\)", PAGE)
TYPED = sorted(set(re.findall(rf"(?:`|^    (?:sudo )?)(?:{BINARY}|zteleop) ([^`\n]+)", PAGE, re.MULTILINE)))
HEADINGS = {
    re.sub(r"[^\w -]", "", title).lower().replace(" ", "-")
    for title in re.findall(r"^#+ (.+)", PAGE, re.MULTILINE)
}


def read_unit() -> dict[str, list[str]]:
    """Return every value of each key; systemd lets keys repeat."""
    keys: dict[str, list[str]] = {}
    section = ""
    for line in (DEPLOY / "zteleop.service").read_text().splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        elif line and not line.startswith("#"):
            key, equals, value = line.partition("=")
            assert equals, line
            keys.setdefault(f"{section}.{key}", []).append(value)
    return keys


UNIT = read_unit()


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("Unit.StartLimitIntervalSec", "0"),
        ("Service.Type", "notify"),
        ("Service.NotifyAccess", "main"),
        ("Service.WatchdogSec", "2"),
        ("Service.WatchdogSignal", "SIGKILL"),
        ("Service.KillMode", "mixed"),
        ("Service.Restart", "always"),
        ("Service.User", "zteleop"),
        ("Service.SupplementaryGroups", "i2c gpio"),
        ("Service.LimitMEMLOCK", "infinity"),
        ("Service.NoNewPrivileges", "yes"),
        ("Install.WantedBy", "multi-user.target"),
    ],
)
def test_the_unit_says(key: str, value: str) -> None:
    assert UNIT[key] == [value]


def test_a_watchdog_that_is_told_to_end_has_not_failed() -> None:
    assert str(128 + 15) in UNIT["Service.SuccessExitStatus"]


def test_nothing_in_the_unit_hides_the_bus_or_forbids_what_is_asked_of_the_kernel() -> None:
    assert not {"Service.PrivateDevices", "Service.RestrictRealtime", "Service.PrivateTmp"}.intersection(UNIT)
    assert {"char-i2c rw", "char-gpiochip rw"} <= set(UNIT["Service.DeviceAllow"])
    assert "/run/lock" in UNIT["Service.ReadWritePaths"][0].split()
    assert int(UNIT["Service.LimitRTPRIO"][0]) in range(20, 50)


def test_what_a_robot_must_not_forget_is_kept_in_the_units_state_folder(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    environment = dict(pair.split("=", 1) for pair in UNIT["Service.Environment"][0].split())
    monkeypatch.setenv("XDG_STATE_HOME", environment["XDG_STATE_HOME"].replace("%S", "/var/lib"))
    (folder,) = UNIT["Service.StateDirectory"]
    kept = config.state_folder("archangel")
    assert kept.is_relative_to(f"/var/lib/{folder}")
    assert str(kept.parent) in PAGE


def can_be_typed(line: str) -> argparse.Namespace:
    verb, *arguments = shlex.split(line)
    assert verb in VERBS
    parser = argparse.ArgumentParser(prog=f"zteleop {verb}", exit_on_error=False)
    importlib.import_module(f"zteleop.cli.{verb}").add_arguments(parser)
    return parser.parse_args(arguments)


@pytest.mark.parametrize(("key", "verb"), [("ExecStart", "actuator"), ("ExecStopPost", "neutral")])
def test_the_units_command_lines_can_be_typed(key: str, verb: str) -> None:
    (line,) = UNIT[f"Service.{key}"]
    program, arguments = line.split(" ", 1)
    assert program == BINARY
    assert arguments.startswith(f"{verb} ")
    assert can_be_typed(arguments).driver == "pca9685"


@pytest.mark.parametrize("line", TYPED)
def test_what_the_page_says_can_be_typed(line: str) -> None:
    can_be_typed(line)


def test_the_page_shows_commands_and_settings() -> None:
    assert {line.split()[0] for line in TYPED} >= {"actuator", "keyboard", "check", "stop"}
    assert len(SETTINGS) >= 2


@pytest.mark.parametrize("link", LINKS)
def test_links_lead_somewhere(link: str) -> None:
    path, _, heading = link.partition("#")
    assert not path or (DEPLOY / path).exists()
    assert not heading or heading in HEADINGS


@pytest.mark.parametrize("text", SETTINGS)
def test_settings_can_be_obeyed(text: str) -> None:
    assert config.parse(text.encode()).drivers["pca9685"]


def test_the_wiring_shows_each_pin_of_the_table() -> None:
    drawn = "".join(ElementTree.parse(DEPLOY / "wiring.svg").getroot().itertext())
    for name in ("VCC", "SDA", "SCL", "OE", "GND", "V+", "channel 0", "channel 1", "GPIO 17"):
        assert name in drawn
        assert name in PAGE
