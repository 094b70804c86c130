"""A config file that is changed: its comments stay, and so does what it was before, beside it."""

import os
import stat
import tempfile
from collections.abc import Callable, Iterator, Mapping
from difflib import unified_diff
from pathlib import Path
from typing import Any

from zteleop import config
from zteleop.config import Config
from zteleop.control.servo import Servo
from zteleop.errors import ConfigError, install

Changes = Mapping[tuple[str, ...], Any]
"""Values by the names of their tables, and their own."""
PULSES = ("min_us", "neutral_us", "max_us")
HOW = {"direct": "", "double_tap": "; tapped twice to reverse", "none": "; without reverse"}
"""what there is to say of an ESC, beside its pulses"""


class SettingsFile:
    """A config file and what it says; one that is not there yet says what is built in.

    Raises ConfigError for a file that is wrong already.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path or config.found() or Path("config.toml")
        there = self.path.exists()
        self.settings = config.load(self.path) if there else Config()
        self.text = self.path.read_text(encoding="utf-8") if there else ""

    @property
    def backup(self) -> Path:
        """Where the file as it was goes."""
        return self.path.with_name(f"{self.path.name}.bak")

    def changed(self, changes: Changes) -> tuple[str, Config]:
        """Return the text with these values, and the settings it makes; raises ConfigError for wrong ones."""
        text = editor()(self.text, changes, dict(self._told(changes)))
        return text, config.parse(text.encode(), str(self.path))

    def difference(self, text: str) -> list[str]:
        """Return, as `diff -u` does, what another text changes."""
        names = (str(self.path), f"{self.path} (new)")
        lines = unified_diff(self.text.splitlines(), text.splitlines(), *names, n=1, lineterm="")
        return list(lines)

    def write(self, text: str) -> None:
        """Put another text in its place, whole or not at all; raises ConfigError where that cannot be."""
        target = self.path.resolve()
        try:
            if self.text:
                self.backup.write_text(self.text, encoding="utf-8")
            with tempfile.NamedTemporaryFile(
                "w", dir=target.parent, prefix=f".{target.name}.", delete=False, encoding="utf-8"
            ) as new:
                new.write(text)
            os.chmod(new.name, stat.S_IMODE(target.stat().st_mode) if target.exists() else 0o644)
            os.replace(new.name, target)
        except OSError as error:
            raise ConfigError(f"cannot write {self.path}: {error.strerror}") from None

    def _told(self, changes: Changes) -> Iterator[tuple[tuple[str, ...], tuple[int, int]]]:
        """Yield for each pulse how many ticks it was, and is to be."""
        tick = self.settings.tick_us
        for path, value in changes.items():
            match path:
                case "drive", "servos", name, field if field in PULSES:
                    if before := self.settings.drive.servos.get(name):
                        yield path, (round(getattr(before, field) / tick), round(value / tick))


def editor() -> Callable[..., str]:
    """Return what changes a text; raises ConfigError where that is not installed."""
    try:
        from zteleop.text.toml_edit import edited
    except ModuleNotFoundError as error:
        raise ConfigError(
            f"changing a config file needs {error.name}, which is not installed; say: {install('calibrate')}"
        ) from None
    return edited


def of_servos(servos: Mapping[str, Servo]) -> dict[tuple[str, ...], Any]:
    """Return what a file must say of these servos, all of it: what it says replaces those built in."""
    return {
        ("drive", "servos", name, field): rounded(getattr(servo, field))
        for name, servo in servos.items()
        for field in ("channel", *PULSES, *(() if name == "steering" else ("dead_zone_us", "reverse")))
    }


def rounded(value: Any) -> Any:
    """Return a pulse to 0.1 us, as a chip counts in longer steps."""
    return round(value, 1) if isinstance(value, float) else value


def pulses_told(before: Config, after: Config) -> list[str]:
    """Return a line for each servo: its pulses in ticks, and those before."""
    tick, lines = after.tick_us, []
    for name, servo in after.drive.servos.items():
        was, old = before.drive.servos.get(name), ""
        if was is not None and (ticks := in_ticks(was, before.tick_us)) != in_ticks(servo, tick):
            old = f", before {ticks}"
        now = f"{in_ticks(servo, tick)} ticks{old}{HOW[servo.reverse]}"
        lines.append(f"{name:8} on channel {servo.channel}: {now}")
    return lines


def in_ticks(servo: Servo, tick: float) -> str:
    """Return least, neutral and most of a servo, as counts of the chip."""
    return " ".join(str(round(getattr(servo, field) / tick)) for field in PULSES)
