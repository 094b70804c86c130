"""How zteleop reaches others, and who is there."""

import socket
from contextlib import closing

from zteleop.bus import networks, presence, times
from zteleop.bus.lane import trial
from zteleop.bus.presence import who_is_here
from zteleop.bus.session import open_session
from zteleop.bus.settings import PORT
from zteleop.cli._company import by_topic, disagreements
from zteleop.cli._patient import Finding, Patient
from zteleop.errors import ZteleopError

SAME_TIME = 0.5
"""s between two clocks from which a recording of both is hard to read"""
MOST_NODES = 100
"""that are asked for their time"""


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


def clocks(patient: Patient) -> Finding:
    try:
        with open_session(patient.settings.bus, settle=True) as session:
            found = times.offsets(session, presence.with_parameters(session)[:MOST_NODES])
    except (ZteleopError, ImportError) as error:
        return Finding(False, str(error))
    told = {one.node: one.seconds for one in found if one.seconds is not None}
    if not told:
        return Finding(None, "no node here tells what time it has")
    node, worst = max(told.items(), key=lambda one: abs(one[1]))
    if abs(worst) < SAME_TIME:
        return Finding(
            True,
            f"{len(told)} node{'s'[: len(told) - 1]}, each within {SAME_TIME:g} s of this machine's clock",
        )
    way = "ahead of" if worst > 0 else "behind"
    words = (
        f"/{node.robot}/{node.node} is {abs(worst):.1f} s {way} this machine's clock, and so are its stamps"
    )
    return Finding(None, f"{words}; on each machine: sudo timedatectl set-ntp true")


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
    missed = settings.robot if settings.robot not in found else None
    here = who_is_here(found, missed or "", unreached)
    if missed:
        return Finding(
            None,
            f"{settings.robot} is not heard, {here}; is its actuator on?",
        )
    return Finding(
        True if found else None,
        here + ("" if found or unreached else "; zteleop demo starts one"),
    )
