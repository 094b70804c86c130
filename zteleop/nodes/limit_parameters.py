"""What bounds a robot as parameters of its actuator: others make it narrower, never wider than its file."""

from collections.abc import Callable, Mapping
from functools import partial

from msgspec.structs import asdict, replace

from zteleop.bus.node import Node
from zteleop.control.drive import Drive
from zteleop.errors import DeviceError
from zteleop.machine.limits_file import LimitsFile

LIMITS = {
    "limits.speed": (0.01, "m/s, how fast it may drive, to the nearest tick of the chip"),
    "limits.turn": (0.01, "rad/s, how fast it may turn"),
    "limits.acceleration": (0.01, "m/s^2, how fast its speed may change; a stop is never softened"),
    "limits.turn_acceleration": (0.01, "rad/s^2, how fast its turning may change"),
    "limits.pulse_duty": (0.01, "share of the time for which the throttle is obeyed"),
    "deadlines.operator": (0.1, "s without an act, after which it rests"),
}
"""The least of what the settings allow that each may be, as below it nobody can drive; and what it is."""
SILENCE = (0.4, "s without a word of its sender, after which the robot rests")
"""the same, of each source"""


class LimitParameters:
    """Narrows what a drive may do as it is told; what was told outlives restarts, as a stop does."""

    def __init__(self, node: Node, drive: Drive, file: LimitsFile, note: Callable[[str], object]) -> None:
        self._node = node
        self._drive = drive
        self._file = file
        self._note = note
        drive.limits = drive.settings.limits.in_numbers(drive.settings.mixer)
        self._widest = bounds(drive)
        kept = self._load()
        silences = {f"sources.{name}.silence": SILENCE for name in drive.settings.known_sources}
        for name, (share, words) in (LIMITS | silences).items():
            most = self._widest[name]
            value = max(share * most, min(kept.get(name, most), most))
            self._set(name, value)
            node.parameter(
                name, value, words, least=share * most, most=most, changed=partial(self._change, name)
            )

    def _load(self) -> Mapping[str, float]:
        try:
            return self._file.load()
        except DeviceError as error:
            self._node.log.warn(
                f"limits that were set before are not known, and those of its settings hold: {error}"
            )
            return {}

    def _change(self, name: str, value: float) -> None:
        self._set(name, value)
        self._note(f"{name} is {value:g}")
        now = bounds(self._drive)
        try:
            self._file.keep({name: now[name] for name in now if now[name] != self._widest[name]})
        except DeviceError as error:
            self._node.log.warn(f"{name} holds, but not across a restart: {error}")

    def _set(self, name: str, value: float) -> None:
        group, field = name.split(".")[:2]
        if group == "limits":
            self._drive.limits = replace(self._drive.limits, **{field: value})
        elif group == "sources":
            self._drive.admission.silences.shorten(field, value)
        else:
            self._drive.admission.operator_silence = value


def bounds(drive: Drive) -> dict[str, float]:
    """Return what holds now, by the names of the parameters."""
    limits = {f"limits.{name}": value for name, value in asdict(drive.limits).items()}
    sources, silences = drive.settings.known_sources, drive.admission.silences
    limits |= {f"sources.{name}.silence": silences.of(name) for name in sources}
    return {**limits, "deadlines.operator": drive.admission.operator_silence}
