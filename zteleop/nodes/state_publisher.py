"""What an actuator says of itself: its beat, what it does and why, and whom it does not obey."""

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.control.drive import Drive, Step
from zteleop.control.explain import layers
from zteleop.control.gate import Refusal
from zteleop.control.proof import NEVER
from zteleop.control.refusals import RefusedSenders
from zteleop.control.report import overridden, refusals, status, to_vehicle
from zteleop.control.snapshot import snapshot
from zteleop.machine.stop_file import StopFile
from zteleop.messages import Beat, DriveStatus, Refusals, Vehicle, Why
from zteleop.nodes.output import Output
from zteleop.nodes.times import ACTUATOR_TO_CHIP, DOOR_TO_ACTUATOR, ROBOT, Times

REPEAT_EVERY = 0.19
"""s between two statuses that say the same: every fourth beat"""


class StatePublisher:
    """Says on the bus what is known in this process."""

    def __init__(self, node: Node, drive: Drive, tick_us: float, output: Output, stop_file: StopFile) -> None:
        self._drive = drive
        self._tick_us = tick_us
        self._output = output
        self._stop_file = stop_file
        self._refused = RefusedSenders()
        self._waiting = RefusedSenders()
        """whose commands count, while another source drives"""
        self._beats = node.publisher("beat", Beat)
        self._statuses = node.publisher("drive_status", DriveStatus)
        self._vehicles = node.publisher("vehicle", Vehicle)
        self._whys = node.publisher("why", Why)
        self._refusals = node.publisher("refusals", Refusals)
        self._times = Times(node, lambda: ROBOT)
        self._told: object = None
        """what was news when the robot last said what it does"""
        self._repeat_at = NEVER

    def note(self, sender: int, source: str, refusal: Refusal | None, now: float) -> None:
        """Remember how a command was judged, for those who must be told."""
        self._refused.note(sender, source, refusal, now)

    def time(self, came: float, taken: float) -> None:
        """Note when this machine and this process had a command that is on the chip now."""
        self._times.note(DOOR_TO_ACTUATOR, taken - came)
        self._times.note(ACTUATOR_TO_CHIP, self._output.evidence.written - taken)

    def tell(self, step: Step) -> None:
        """Say what commands must echo from now on, and what the robot does while that is news."""
        now = clock.now()
        self._beats.publish(self._drive.admission.beat(now))
        if step.claim or self._news(step) != self._told or now >= self._repeat_at:
            self.tell_status(step)

    def tell_status(self, step: Step) -> None:
        """Say what the robot does."""
        chip, unkept = self._output.evidence, self._stop_file.unkept
        now = clock.now()
        self._statuses.publish(status(self._drive, step, chip, now, unkept))
        self._told, self._repeat_at = self._news(step), now + REPEAT_EVERY

    def _news(self, step: Step) -> object:
        """Return what a robot that nobody drives would be asked for at once, if it changed."""
        known = self._output.evidence.confirmed, self._stop_file.unkept
        return step.state, step.why, step.pulse_us, step.bound, known

    def describe(self, step: Step) -> None:
        """Say what the robot is, why it does what it does, and who is refused."""
        vehicle = to_vehicle(
            self._drive.settings, self._tick_us, step.state != "starting", self._drive.limits
        )
        vehicle.operator_silence = self._drive.admission.operator_silence
        self._vehicles.publish(vehicle)
        now = clock.now()
        seen = snapshot(self._drive, step, now)
        self._whys.publish(Why(layers(seen, self._output.evidence)))
        for claim in seen.claims:
            self._waiting.note(claim.sender, claim.source, overridden(seen, claim), now)
        refused, waiting = self._refused.news(now), self._waiting.news(now)
        if refused is None and waiting is None:  # nothing while all is well
            return
        told = {**(waiting or {}), **(refused or {})}
        if not seen.holds and any(turned.why is Refusal.AT_REST for turned in told.values()):
            return  # what they were told before is over, and their next command finds out what is so now
        self._refusals.publish(refusals(self._drive, told, now))
