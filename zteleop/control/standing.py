"""What must outlive an actuator that is only late: who may go on when another takes its place.

An actuator tells its watchdog with each step. One that crashed is followed by a start, which nobody
outlives; one that was ended for being late is an interruption like any other.
"""

from typing import NamedTuple

from zteleop.control.drive import Drive
from zteleop.control.proof import NEVER

NOBODY = -1


class Standing(NamedTuple):
    """Where a drive stands; times are the robot's, in seconds."""

    epoch: int
    since: float
    """when the epoch began"""
    floor: float
    """Claims that began earlier are over: the last start, or the last release."""
    interrupted: float
    """when the last interruption ended"""
    source: int = NOBODY
    """The place among the robot's known sources of whoever drove last, and has not let go."""
    sender: int = 0
    began: float = 0.0
    counted: float = 0.0
    """when a command of that claim last counted"""


def stand(drive: Drive, since: float) -> Standing:
    """Return what another drive needs to go on in the place of this one."""
    gate = drive.admission.gate
    standing = Standing(gate.epoch, since, gate.floor, max(since, drive.admission.interruption.ended))
    claim = drive.admission.driver
    if claim is None or (counted := gate.last_counted(claim.sender)) == NEVER:
        return standing
    source = list(drive.settings.known_sources).index(claim.source)
    return standing._replace(source=source, sender=claim.sender, began=claim.began, counted=counted)


def go_on(drive: Drive, standing: Standing, why: str, now: float) -> None:
    """Take the place of another drive of the same epoch, as after an interruption.

    Whoever drove keeps right and place for as long as after a lost link; all others begin anew.
    """
    drive.admission.gate.take_over(standing.floor)
    if standing.source != NOBODY:
        source = list(drive.settings.known_sources)[standing.source]
        drive.admission.recall(source, standing.sender, standing.began, standing.counted, now)
    drive.admission.interrupt(why, now, drive.settings.deadlines.link_loss)
