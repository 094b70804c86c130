"""What a Raspberry Pi says of its supply and its heat; any other computer says nothing."""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Protocol

from zteleop.control.cap import AT_EASE, Strain

LOOK_EVERY = 1.0
KEPT = 5.0
"""s that a strain lasts after it was last seen, so that what comes and goes does not jerk the robot."""
HOT, TOO_HOT = 80.0, 85.0
"""Degrees Celsius from which a Pi slows itself down, and down to its least."""
ZONES = ("cpu-thermal", "cpu_thermal")
UNDERVOLTAGE = Strain(0.5, "the Pi's supply is too low (undervoltage); use a better one")
HEAT = Strain(0.5, f"the Pi is hotter than {HOT:g} C; give it air")
GREAT_HEAT = Strain(0.25, f"the Pi is hotter than {TOO_HOT:g} C; give it air")


THROTTLED = "devices/platform/soc/soc:firmware/get_throttled"
"""below /sys, a number in hexadecimal: what is, and in its upper half what was since the start"""
WAS = {16: "its supply was too low", 17: "it was slowed down", 18: "it was throttled", 19: "it was hot"}


class Log(Protocol):
    def info(self, text: str) -> object: ...

    def warn(self, text: str) -> object: ...


class Pi:
    """Reads files of the kernel, which answers from memory and a register: none waits for anything."""

    def __init__(self, root: Path) -> None:
        self._throttled = root / THROTTLED
        self._alarm, self._temperature = _find(root)

    @property
    def is_one(self) -> bool:
        """There is something to look at."""
        return bool(self._alarm or self._temperature)

    @property
    def temperature(self) -> float:
        """In degrees Celsius; 0 where nothing says it."""
        return _number(self._temperature) / 1000 if self._temperature else 0.0

    def strains(self) -> Iterator[Strain]:
        """Yield what is the matter now."""
        if self._alarm and _number(self._alarm) == 1:
            yield UNDERVOLTAGE
        temperature = self.temperature
        if temperature >= HOT:
            yield GREAT_HEAT if temperature >= TOO_HOT else HEAT

    def hardships(self) -> list[str]:
        """Return what it has gone through since its start, in words."""
        try:
            bits = int(_text(self._throttled), 16)
        except ValueError:
            return []
        return [words for bit, words in WAS.items() if bits >> bit & 1]


class Health:
    """The strain of a Pi that lasts, told to a log."""

    def __init__(self, root: Path, log: Log) -> None:
        self._log = log
        self._pi = Pi(root)
        self._last: dict[Strain, float] = {}
        """When each strain was last seen."""
        self._worst = AT_EASE

    def look(self, now: float) -> Strain:
        """Return the worst strain of the last seconds, and tell the log when it is another one."""
        self._last |= dict.fromkeys(self._pi.strains(), now)
        lasting = [strain for strain, seen in self._last.items() if now - seen <= KEPT]
        worst = worst_of(lasting)
        if worst != self._worst:
            self._tell(worst)
        self._worst = worst
        return worst

    def _tell(self, worst: Strain) -> None:
        if worst == AT_EASE:
            self._log.info("the Pi's supply and heat are good again; full speed")
        else:
            self._log.warn(f"at most {worst.share:.0%} of full speed: {worst.why}")


def worst_of(strains: Iterable[Strain]) -> Strain:
    """Return the strain that slows down most; AT_EASE where there is none."""
    return min(strains, key=lambda strain: strain.share, default=AT_EASE)


def _find(root: Path) -> tuple[Path | None, Path | None]:
    """Return the files of a Pi's undervoltage and temperature; none where this is no Pi."""
    alarm = next(_named(root / "class/hwmon", "name", ("rpi_volt",)), None)
    if alarm is None and not _text(root / "firmware/devicetree/base/model").startswith("Raspberry Pi"):
        return None, None
    zone = next(_named(root / "class/thermal", "type", ZONES), None)
    return alarm and alarm / "in0_lcrit_alarm", zone and zone / "temp"


def _named(folder: Path, file: str, names: tuple[str, ...]) -> Iterator[Path]:
    """Yield the devices of a class that go by one of these names."""
    yield from (device for device in sorted(folder.glob("*")) if _text(device / file).strip() in names)


def _number(path: Path) -> int:
    """Return what a file says; 0 when it cannot be read."""
    try:
        return int(_text(path))
    except ValueError:
        return 0


def _text(path: Path) -> str:
    with suppress(OSError):
        return path.read_text(errors="replace")
    return ""
