"""What a person wants to know of a recording: who drove, what changed, and why the robot came to rest."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

import msgspec
from msgspec import Struct

from zteleop.bus.topics import topic_of
from zteleop.messages import Log
from zteleop.recording.blackbox_file import Header, Recorded
from zteleop.recording.senders import Senders

GATHER, LONGEST_GATHER = 1.0, 5.0
"""s between events of one kind, and from the first to the last, that are one line with a number"""
BEAT_GAP = 0.3
"""s between two beats that are worth a line; they come every 0.05 s"""
CHANGED = " now, and was "
"""what a node says of a parameter that somebody changed: a reason to drive otherwise"""
_LEVELS = {Log.WARN: "warns", Log.ERROR: "reports an error", 50: "reports a fatal error"}


class Event(Struct):
    """A line of a timeline; those of one `subject` soon after each other become one."""

    at: float
    text: str
    subject: str = ""
    reason: bool = False
    """the file was written because of this"""
    until: float = 0.0
    count: int = 1


class _Pulse(Struct):
    name: str = ""
    fraction: float = 0.0
    duty_ticks: int = 0


class _Status(Struct):
    state: str = ""
    why: str = ""
    operator: str = ""
    pulses: list[_Pulse] = []


class _Stop(Struct):
    engaged: bool
    id: int = 0
    by: str = ""
    why: str = ""


class _Dog(Struct):
    state: str = ""
    why: str = ""
    moving: bool = False
    restarts: int = 0


class _Log(Struct):
    level: int = 0
    name: str = ""
    msg: str = ""


class _Beat(Struct):
    epoch: int
    time: float = 0.0


class Timeline:
    """Reads messages in the order of time and notes what is new."""

    def __init__(self, header: Header) -> None:
        self._prefix = f"robot/{header.robot}/"
        self.events: list[Event] = []
        self._senders = Senders(self._note)
        self._status: _Status | None = None
        self._rest: list[int] = []
        """ticks of pulses that moved nothing"""
        self._moving = False
        self._dog: _Dog | None = None
        self._beat: tuple[int, float] | None = None
        self._stops: set[tuple[int, bool]] = set()
        self._readers: dict[str, tuple[type[Struct], Callable[[Any, float], None]]] = {
            "drive_status": (_Status, self._hear_status),
            "stop": (_Stop, self._hear_stop),
            "watchdog": (_Dog, self._hear_watchdog),
            "log": (_Log, self._hear_log),
            "beat": (_Beat, self._hear_beat),
        }

    def learn(self, lines: Sequence[Recorded]) -> None:
        """Take what rest is from the first vehicle; it holds for the commands before it as well."""
        for line in reversed(lines):
            if line.key == f"{self._prefix}vehicle":
                self._senders.learn(line.payload)

    def hear(self, line: Recorded) -> None:
        """Note what a message changes."""
        path = line.key.removeprefix(self._prefix)
        if line.wrong:
            self._note(line.at, f"{path}: nobody understood a message: {line.wrong}", f"wrong {path}")
        elif topic_of(path).command:
            self._senders.hear(path, line)
        elif path == "vehicle":
            self._senders.learn(line.payload)
        elif reader := self._readers.get(path):
            kind, handler = reader
            try:
                handler(msgspec.convert(line.payload, kind), line.at)
            except msgspec.ValidationError as error:
                self._note(line.at, f"{path}: this version cannot read a message: {error}", f"other {path}")

    def finish(self, end: float) -> None:
        """Note who fell silent and never spoke again."""
        self._senders.finish(end)

    def _note(self, at: float, text: str, subject: str = "") -> None:
        self.events.append(Event(at, text, subject, until=at))

    def _hear_status(self, status: _Status, at: float) -> None:
        before, self._status = self._status, status
        if before is None or (before.state, before.operator) != (status.state, status.operator):
            self._note(at, f"{status.state}: {status.why}")
        moving, was = self._pulses_move(status), self._moving
        self._moving = moving
        if before and was != moving:
            pulses = ", ".join(f"{p.name} {p.duty_ticks}" for p in reversed(status.pulses))
            self._note(at, f"pulses {'move' if moving else 'at rest'}: {pulses}")

    def _pulses_move(self, status: _Status) -> bool:
        """Say whether pulses move something that can be told: less than a tick beside rest cannot."""
        ticks = [pulse.duty_ticks for pulse in status.pulses]
        at_rest = not any(pulse.fraction for pulse in status.pulses)
        self._rest = ticks if at_rest else self._rest
        return not at_rest and ticks != self._rest

    def _hear_stop(self, stop: _Stop, at: float) -> None:
        if (stop.id, stop.engaged) in self._stops:  # it is repeated until it is acknowledged
            return
        self._stops.add((stop.id, stop.engaged))
        said = "says stop" if stop.engaged else "releases the stop"
        self._note(at, f"{stop.by or 'somebody'} {said}" + (f": {stop.why}" if stop.why else ""))

    def _hear_watchdog(self, dog: _Dog, at: float) -> None:
        before, self._dog = self._dog, dog
        rests = dog.state == "resting" and not dog.moving
        if rests and before and (before.moving or self._moving):
            self._note(at, "the watchdog reads pulses of rest")
        self._moving &= not rests  # what an actuator says later was so before
        if before is None or (before.state, before.restarts) == (dog.state, dog.restarts):
            return
        again = ", another actuator is started" if dog.restarts > before.restarts else ""
        self._note(at, f"watchdog {dog.state}{again}: {dog.why}")

    def _hear_log(self, log: _Log, at: float) -> None:
        level = _LEVELS.get(log.level) or ("says" if CHANGED in log.msg else "")
        if level:
            self._note(at, f"{log.name} {level}: {log.msg}", f"log {log.level} {log.name} {log.msg[:40]}")

    def _hear_beat(self, beat: _Beat, at: float) -> None:
        before, self._beat = self._beat, (beat.epoch, at)
        if before and before[0] != beat.epoch:
            self._note(at, "the actuator begins anew: who drove must let go first")
        elif before and at - before[1] > BEAT_GAP:
            self._note(at, f"the first beat of the actuator for {at - before[1]:.2f} s")


def timeline(header: Header, lines: Sequence[Recorded]) -> list[Event]:
    """Return what happened, in the order of time by the robot's bus clock."""
    heard = Timeline(header)
    last = header.at
    heard.learn(lines)
    for line in lines:
        heard.hear(line)
        last = max(last, line.at)
    heard.finish(last)
    events = [*heard.events, *_floods(header)]
    return _mark(header, list(_gather(sorted(events, key=lambda event: event.at))))


def _floods(header: Header) -> Iterator[Event]:
    for path, rates in header.floods.items():
        if not rates:
            continue
        most = max(count for _, count in rates)
        yield Event(rates[0][0], f"a flood on {path}: up to {most} messages a second, {_span(len(rates))}")
    if header.elsewhere:
        yield Event(header.at, f"{header.elsewhere} messages on more topics than there is room for")


def _span(seconds: int) -> str:
    return f"for {seconds} s" if seconds > 1 else "within a second"


def _gather(events: Iterable[Event]) -> Iterator[Event]:
    """Make one event of those of one subject that follow each other within a second."""
    open_events: dict[str, Event] = {}
    found = []
    for event in events:
        first = open_events.get(event.subject) if event.subject else None
        if first and event.at - first.until <= GATHER and event.at - first.at <= LONGEST_GATHER:
            first.count, first.until = first.count + 1, event.at
            first.text = event.text
        else:
            open_events[event.subject] = event
            found.append(event)
    for event in found:
        if event.count > 1:
            event.text += f" (the last of {event.count} in {max(0.01, event.until - event.at):.2f} s)"
        yield event


def _mark(header: Header, events: list[Event]) -> list[Event]:
    """Mark what the file was written for; where no message says it, add a line."""
    for number, trigger in enumerate(header.triggers):
        told = [event for event in events if event.at == trigger.at and trigger.why in event.text]
        stopped = [event for event in events if event.at == trigger.at and " says stop" in event.text]
        found = next(iter(stopped or told), None)
        if found is None:
            found = Event(trigger.at, f"{trigger.reason.replace('-', ' ')}: {trigger.why}")
            events.append(found)
        found.reason = found.reason or number == 0
    return sorted(events, key=lambda event: event.at)
