"""A drive as it stood at one step, for whoever tells of it."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from zteleop.control.calibration import Calibration
from zteleop.control.drive import Drive, Step
from zteleop.control.hold import Hold
from zteleop.control.limiter import Limits
from zteleop.control.mux import Claim
from zteleop.control.refusals import Refused, Sender
from zteleop.control.settings import DriveSettings

RECENT = 10.0
"""s for which a refusal is worth a sentence of its own; beside the reason to rest it is told for less"""


class Snapshot(NamedTuple):
    """All of a drive that a sentence needs, as it was at one step."""

    settings: DriveSettings
    limits: Limits
    """that hold now"""
    calibration: Calibration
    step: Step
    claims: list[Claim]
    """whose senders are not silent, whoever of them drives"""
    refused: Mapping[Sender, Refused]
    """lately"""
    holds: Sequence[Hold]
    """why it is at rest, the reason to tell first in front"""
    stopped: bool
    """a stop is in force"""
    foreign: bool
    """whoever drives cannot prove how old its commands are"""
    top: float
    """m/s that the vehicle can do"""
    strain: str
    """why its machine must spare it, where it must"""
    now: float


def snapshot(drive: Drive, step: Step, now: float) -> Snapshot:
    """Return how a drive stands at a step."""
    admission, cap = drive.admission, drive.movement.cap
    return Snapshot(
        settings=drive.settings,
        limits=drive.limits,
        calibration=drive.calibration,
        step=step,
        claims=[claim for claim in admission.mux.claims if not admission.silences.silent(claim, now)],
        refused=admission.refusals.recent(now, RECENT),
        holds=admission.holds.in_order,
        stopped=bool(admission.latch.stops),
        foreign=step.claim is not None and admission.foreign.includes(step.claim),
        top=cap.top,
        strain=cap.strain.why,
        now=now,
    )
