"""Who commanded in a recording: when each began, changed its command, paused, let go or fell silent."""

from collections import deque
from collections.abc import Callable
from typing import Any

import msgspec
from msgspec import Struct

from zteleop.control.proof import called
from zteleop.recording.blackbox_file import Recorded

PAUSE = 0.15
"""s between two commands, if it is also twice what this sender usually takes"""
Note = Callable[[float, str, str], None]


class _Channel(Struct):
    name: str = ""
    neutral_ticks: int = 0


class _Vehicle(Struct):
    channels: list[_Channel] = []


class Sender:
    """One of those who command."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.said: str = ""
        self.moving = False
        self.at = 0.0
        self.gaps: deque[float] = deque(maxlen=50)

    @property
    def period(self) -> float:
        """Seconds between two commands, usually; 0 before there are two."""
        return sorted(self.gaps)[len(self.gaps) // 2] if self.gaps else 0.0

    @property
    def rate(self) -> str:
        return f"{1 / self.period:.0f} a second until then" if 0 < self.period <= 1 else "seldom before"


class Senders:
    """Follows every sender of commands, and tells `note` a time, a sentence and its subject."""

    def __init__(self, note: Note) -> None:
        self._note = note
        self._senders: dict[tuple[str, int | None], Sender] = {}
        self._neutral: dict[str, int] = {}
        """ticks; empty while nobody has said what rest is, and then no ticks are"""

    def learn(self, vehicle: Any) -> None:
        """Take the pulses of rest from what a robot said of itself."""
        try:
            channels = msgspec.convert(vehicle, _Vehicle).channels
        except msgspec.ValidationError:
            return
        self._neutral = {channel.name: channel.neutral_ticks for channel in channels} or self._neutral

    def hear(self, path: str, line: Recorded) -> None:
        """Follow one command."""
        number = line.proof.sender if line.proof else None
        sender = self._senders.get((path, number)) or self._meet(path, number)
        said, moving = self._read(line.payload)
        gap = line.at - sender.at
        subject = f"{path} {number}"
        if moving and not sender.moving:
            self._note(line.at, f"{sender.name} begins: {said}", f"{subject} begins")
            sender.gaps.clear()
        elif moving:
            self._go_on(sender, said, gap, line.at, subject)
        elif sender.moving:
            self._note(line.at, f"{sender.name} lets go: {said}", f"{subject} lets go")
        sender.said, sender.moving, sender.at = said, moving, line.at

    def finish(self, end: float) -> None:
        """Tell of everybody who fell silent in the middle of driving."""
        for (path, number), sender in self._senders.items():
            if sender.moving and end - sender.at > max(PAUSE, 2 * sender.period):
                last = f"{sender.name} says its last word ({sender.rate})"
                self._note(sender.at, last, f"{path} {number} last")

    def _go_on(self, sender: Sender, said: str, gap: float, at: float, subject: str) -> None:
        if gap > max(PAUSE, 2 * sender.period):
            self._note(at, f"{sender.name} goes on after {gap:.2f} s of silence: {said}", f"{subject} pauses")
        elif said != sender.said:
            self._note(at, f"{sender.name}: {said}", f"{subject} changes")
        sender.gaps.append(gap)

    def _meet(self, path: str, number: int | None) -> Sender:
        source = path.partition("/")[2] or path
        name = f"{source} without proof" if number is None else called(source, f"{number:x}")
        return self._senders.setdefault((path, number), Sender(name))

    def _read(self, values: Any) -> tuple[str, bool]:
        """Return a command in words, and whether it is anything but rest."""
        if not isinstance(values, dict):
            return "what is no command", False
        if "steering_ticks" in values:
            return self._pulses(values.get("steering_ticks"), values.get("throttle_ticks"))
        if "data" in values:
            data = values["data"] if isinstance(values["data"], list) else []
            return self._pulses(*[*data, None, None][:2])
        twist = values.get("twist", values)
        speed, turn = _number(twist, "linear", "x"), _number(twist, "angular", "z")
        return f"{speed:+.2f} m/s {turn:+.2f} rad/s", bool(speed or turn)

    def _pulses(self, steering: object, throttle: object) -> tuple[str, bool]:
        rest = (self._neutral.get("steering"), self._neutral.get("throttle"))
        return f"steering {str(steering)[:20]}, throttle {str(throttle)[:20]}", (steering, throttle) != rest


def _number(values: Any, *path: str) -> float:
    for name in path:
        values = values.get(name) if isinstance(values, dict) else None
    try:
        return float(values)
    except (TypeError, ValueError, OverflowError):
        return 0.0
