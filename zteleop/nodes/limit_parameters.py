"""The limits of motion as parameters of an actuator: others make them narrower, never wider than its file."""

from collections.abc import Callable
from functools import partial

from msgspec.structs import asdict, replace

from zteleop.bus.node import Node
from zteleop.control.drive import Drive
from zteleop.control.limiter import Limits
from zteleop.errors import DeviceError
from zteleop.machine.limits_file import LimitsFile

LIMITS = {
    "speed": "m/s, how fast it may drive",
    "turn": "rad/s, how fast it may turn",
    "acceleration": "m/s^2, how fast its speed may change; a stop is never softened",
    "turn_acceleration": "rad/s^2, how fast its turning may change",
    "pulse_duty": "share of the time for which the throttle is obeyed",
}
LEAST = 0.01
"""of what the settings allow, below which nobody need go: stopping is another thing"""


class LimitParameters:
    """Narrows a drive's limits as it is told; what was told outlives restarts, as a stop does."""

    def __init__(self, node: Node, drive: Drive, file: LimitsFile, note: Callable[[str], object]) -> None:
        self._node = node
        self._drive = drive
        self._file = file
        self._note = note
        self._widest = drive.settings.limits.in_numbers(drive.settings.mixer)
        drive.limits = self._narrowed(self._load())
        for name, words in LIMITS.items():
            most: float = getattr(self._widest, name)
            node.parameter(
                f"limits.{name}",
                float(getattr(drive.limits, name)),
                words,
                least=LEAST * most,
                most=most,
                changed=partial(self._change, name),
            )

    def _load(self) -> dict[str, float]:
        try:
            return self._file.load()
        except DeviceError as error:
            self._node.log.warn(
                f"limits that were set before are not known, and those of its settings hold: {error}"
            )
            return {}

    def _narrowed(self, values: dict[str, float]) -> Limits:
        """Return the settings' limits, narrower where values say so."""
        widest: dict[str, float] = {name: getattr(self._widest, name) for name in LIMITS}
        told = {
            name: max(min(values[name], most), LEAST * most)
            for name, most in widest.items()
            if name in values
        }
        return replace(self._widest, **told)

    def _change(self, name: str, value: float) -> None:
        self._drive.limits = replace(self._drive.limits, **{name: value})
        self._note(f"limits.{name} is {value:g}")
        ours, widest = asdict(self._drive.limits), asdict(self._widest)
        try:
            self._file.keep({name: ours[name] for name in LIMITS if ours[name] != widest[name]})
        except DeviceError as error:
            self._node.log.warn(f"limits.{name} holds, but not across a restart: {error}")
