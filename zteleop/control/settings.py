"""The vehicle, who may drive it, and its bounds."""

from collections.abc import Iterable

from msgspec import Struct, field

from zteleop.control.cap import CapSettings
from zteleop.control.deadlines import PROGRAM_SILENCE, Deadlines
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Ackermann, Mixer
from zteleop.control.mux import Source
from zteleop.control.servo import Servo

DONKEYCAR = {
    "throttle": Servo(channel=0, min_us=897.6, neutral_us=1509.6, max_us=2040.0, dead_zone_us=15.0),
    "steering": Servo(channel=1, min_us=1183.2, neutral_us=1530.0, max_us=1876.8),
}
"""220, 370, 500 and 290, 375, 460 ticks at 60 Hz, as Donkeycar ships them."""

SOURCES = {
    "web": Source(priority=100),
    "gamepad": Source(priority=95),
    "keyboard": Source(priority=90),
    "buttons": Source(priority=80),
    "program": Source(priority=50, silence=PROGRAM_SILENCE),
    "planner": Source(priority=10, silence=PROGRAM_SILENCE),
}
INPUTS = ("web", "gamepad", "keyboard", "buttons")
"""those at which a person sits, who sees what is obeyed; any other is a program"""
REPLACES = "what is written here replaces those built in"


class DriveSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """The vehicle, who may drive it, and its bounds."""

    mixer: Mixer = Ackermann()
    servos: dict[str, Servo] = field(default_factory=DONKEYCAR.copy)
    sources: dict[str, Source] = {}
    """besides, or instead of, those every robot knows"""
    limits: Limits = Limits()
    cap: CapSettings = CapSettings()
    deadlines: Deadlines = Deadlines()

    @property
    def known_sources(self) -> dict[str, Source]:
        return SOURCES | self.sources

    def __post_init__(self) -> None:
        if set(self.servos) != self.mixer.wheels:
            built_in = self.servos == DONKEYCAR
            more = " and ".join(f"[drive.servos.{name}]" for name in sorted(self.mixer.wheels))
            raise ValueError(
                f"expected servos {_names(self.mixer.wheels)}, found {_names(self.servos)}"
                + (f", which are built in: write {more}" if built_in else f"; {REPLACES}")
            )
        on: dict[int, list[str]] = {}
        for name, servo in self.servos.items():
            on.setdefault(servo.channel, []).append(name)
        for channel, names in on.items():
            if len(names) > 1:
                raise ValueError(
                    f"each servo needs a channel of its own, found {_names(names)} on channel {channel}"
                )
        for name in self.mixer.wheels - self.mixer.driven:
            if self.servos[name].reverse != "direct":
                raise ValueError(f"reverse is for what drives, found it at servos.{name}")
        for name, source in self.sources.items():
            if source.resume and source.trust != "arrival":
                raise ValueError(f'resume is for trust = "arrival", found it at sources.{name}')


def _names(names: Iterable[str]) -> str:
    return ", ".join(sorted(names))
