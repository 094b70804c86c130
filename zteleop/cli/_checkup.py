"""What zteleop runs on, and what each of it must be: one check, one line in the table at the end."""

import errno
import os
import platform
import re
import socket
import sys
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from importlib import metadata
from typing import NamedTuple

from zteleop.bus import networks, presence
from zteleop.bus.lane import trial
from zteleop.bus.session import open_session
from zteleop.bus.settings import PORT
from zteleop.cli._company import by_topic, disagreements, who_is_here
from zteleop.config import Config
from zteleop.drivers.i2c import failure
from zteleop.errors import ZteleopError
from zteleop.machine import realtime
from zteleop.processes import PROGRAMS
from zteleop.terminal.capabilities import speaks_unicode, wants_color

BUILT = 2024
"""the year before which no clock that is set can be"""


class Patient(NamedTuple):
    """What is looked at."""

    settings: Config
    wrong: str
    """what is wrong with the config file, if anything"""
    terminal: int | None
    """the file that is one"""


class Finding(NamedTuple):
    """What a check came to."""

    good: bool | None
    """None: it may hinder some, and is worth knowing"""
    words: str


def python(patient: Patient) -> Finding:
    return Finding(True, f"{platform.python_version()} on {platform.system()} {platform.machine()}")


def packages(patient: Patient) -> Finding:
    found, missing = [f"zteleop {metadata.version('zteleop')}"], []
    needs = [
        re.match(r"[\w-]+", line) for line in metadata.requires("zteleop") or () if "extra ==" not in line
    ]
    for name in [need[0] for need in needs if need]:
        try:
            found.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            missing.append(name)
    if missing:
        return Finding(
            None if missing == ["smbus2"] and not _real(patient) else False,
            f"missing: {', '.join(missing)}; pip install them",
        )
    return Finding(True, ", ".join(found))


def config_file(patient: Patient) -> Finding:
    if patient.wrong:
        return Finding(False, patient.wrong)
    driver, robot = patient.settings.driver, patient.settings.robot or "no robot by name"
    return Finding(True, f"driver {driver}, {robot}; zteleop check says more")


def i2c(patient: Patient) -> Finding:
    path = f"/dev/i2c-{patient.settings.driver_settings('pca9685', 'any').get('bus', 1)}"
    if os.access(path, os.R_OK | os.W_OK):
        return Finding(True, f"{path} can be used")
    if not _real(patient):
        return Finding(None, f"{path} is not there, or not yours to use; only a real chip needs it")
    number = errno.EACCES if os.path.exists(path) else errno.ENOENT
    return Finding(False, str(failure(OSError(number, ""), path)))


def _real(patient: Patient) -> bool:
    """Say whether a real chip is to be driven."""
    return patient.settings.driver == "pca9685"


def privileges(patient: Patient) -> Finding:
    watchdog = PROGRAMS["watchdog"]
    if missing := realtime.try_out(watchdog.priority, watchdog.oom_score):
        words = f"no {', '.join(missing)}: on a busy machine a robot rests late; deploy/README.md says how"
        return Finding(False if _real(patient) else None, words)
    return Finding(True, "real-time priority, locked memory, low OOM score")


def terminal(patient: Patient) -> Finding:
    if patient.terminal is None:
        return Finding(None, "this is none; zteleop keyboard needs one")
    columns, rows = os.get_terminal_size(patient.terminal)
    kind = os.environ.get("TERM", "")
    if kind in ("", "dumb"):
        return Finding(
            False, f"TERM is {kind or 'not set'}, and nothing can be drawn; try TERM=xterm-256color"
        )
    colors = "colours" if wants_color(os.environ) else "no colours"
    signs = "Unicode" if speaks_unicode(os.environ, sys.stdout.encoding) else "ASCII"
    return Finding(
        True,
        f"{kind}, {columns} x {rows}, {colors}, {signs}; zteleop keyboard says what it tells of keys",
    )


def clock(patient: Patient) -> Finding:
    now = datetime.now().astimezone()
    if now.year < BUILT:
        return Finding(
            False, f"it says {now:%Y-%m-%d}, and so will recordings; sudo timedatectl set-ntp true"
        )
    return Finding(True, f"{now:%Y-%m-%d %H:%M %Z}; commands do not depend on it")


def port(patient: Patient) -> Finding:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_STREAM)) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("", PORT))
            probe.listen()
        except OSError as error:
            words = f"{PORT}/tcp: {error.strerror}; a robot here may have it, another goes on without"
            return Finding(None, words)
    return Finding(True, f"{PORT}/tcp is free for a robot")


def multicast(patient: Patient) -> Finding:
    if not patient.settings.bus.multicast:
        return Finding(None, "switched off: robots are found only where -e, or connect of config.toml, says")
    if networks.is_in_none():
        return Finding(None, "this machine is in no network; its own programs and robots find each other")
    try:
        heard, why = trial.hears_itself(), "nothing comes back"
    except OSError as error:
        heard, why = False, str(error.strerror)
    if not heard:
        return Finding(False, f"{why}: robots are not found by themselves; say -e tcp/pi.local:{PORT}")
    return Finding(True, "this machine hears what it says to a group")


def robots(patient: Patient) -> Finding:
    settings = patient.settings
    try:
        with open_session(settings.bus, settle=True) as session:
            found, there = presence.robots(session), presence.endpoints(session)
            unreached = session.unreached()
    except (ZteleopError, ImportError) as error:
        return Finding(False, str(error))
    told = (f"{topic}: {words}" for topic, those in by_topic(there).items() for words in disagreements(those))
    if words := next(told, ""):
        return Finding(False, words)
    here = who_is_here(found, settings.robot or "", unreached)
    if settings.robot and settings.robot not in found:
        return Finding(
            None,
            f"{settings.robot} is not heard, {here}; is its actuator on?",
        )
    return Finding(
        True if found else None,
        here + ("" if found or unreached else "; zteleop demo starts one"),
    )


CHECKS: dict[str, Callable[[Patient], Finding]] = {
    "python": python,
    "packages": packages,
    "config": config_file,
    "i2c": i2c,
    "privileges": privileges,
    "terminal": terminal,
    "clock": clock,
    "port": port,
    "multicast": multicast,
    "robots": robots,
}
