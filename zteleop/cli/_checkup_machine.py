"""What zteleop runs on, and what each of it must be."""

import errno
import os
import platform
import re
import sys
from datetime import datetime
from importlib import metadata
from pathlib import Path

from zteleop.cli._patient import Finding, Patient
from zteleop.control.cap import AT_EASE
from zteleop.drivers.i2c import failure
from zteleop.machine import leftovers, realtime
from zteleop.machine.health import Pi, worst_of
from zteleop.processes import PROGRAMS
from zteleop.terminal.capabilities import speaks_unicode, wants_color

BUILT = 2024
"""the year before which no clock that is set can be"""
SYS = Path("/sys")


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
    number = errno.EACCES if os.path.exists(path) else errno.ENOENT
    words = str(failure(OSError(number, ""), path))
    if not _real(patient):
        return Finding(None, f"{words}; only a real chip needs it")
    return Finding(False, words)


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


def supply(patient: Patient) -> Finding:
    pi = Pi(SYS)
    if not pi.is_one:
        return Finding(None, "this is no Raspberry Pi, whose supply and heat slow a robot down")
    if (strain := worst_of(pi.strains())) != AT_EASE:
        return Finding(False, strain.why)
    if went := pi.hardships():
        return Finding(None, f"good now; since its start {', '.join(went)}; a better supply, or more air")
    return Finding(True, f"good, {pi.temperature:.0f} C")


def processes(patient: Patient) -> Finding:
    if (found := leftovers.running()) is None:
        return Finding(None, "nobody can tell which processes of zteleop run here: there is no ps")
    if frozen := [f"{one.verb} ({one.pid})" for one in found if one.frozen]:
        words = "stopped, and holds what it has: kill -CONT NUMBER lets it go on, kill -KILL NUMBER ends it"
        return Finding(False, f"{', '.join(frozen)}: {words}")
    lost = [f"{one.verb} ({one.pid}, for {one.age})" for one in found if not one.seated]
    if lost:
        words = f"{', '.join(lost)}: without a terminal; where no service started one, kill NUMBER ends it"
        return Finding(None, words)
    seated = ", ".join(f"{one.verb} ({one.pid})" for one in found)
    return Finding(True, f"{seated}: each at a terminal" if seated else "no other of zteleop runs here")
