"""Who drove, when, and what was refused: the log book of a robot, in JSON lines."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

from msgspec import Struct

from zteleop.bus import clock
from zteleop.messages import Pwm, Twist
from zteleop.recording.journal_file import Entry, JournalFile

Detail = Literal["acts", "all", "off"]

ACTS = 10
"""lines a second for acts"""
AWAY = 2.0
"""s of silence, after which a sender is news once more"""
SENDERS = 64


class Accepted(Struct):
    """What was last accepted of a sender."""

    acted: float | None
    at: float


class Refused(Struct):
    """What was last written of a source that was refused."""

    sender: int | None
    why: str | None
    at: float


class Journal:
    """Keeps acts, or every command; never raises, never waits, and warns once when it cannot write."""

    def __init__(self, folder: Path, detail: Detail, warn: Callable[[str], object] = lambda _: None) -> None:
        self._all = detail == "all"
        self._warn = warn
        self._warned = False
        self._accepted: dict[int | None, Accepted] = {}
        self._refused: dict[str, Refused] = {}
        self._ration = Ration()
        self._file = JournalFile(folder / "journal.jsonl") if detail != "off" else None
        self._look()

    def command(
        self,
        source: str,
        sender: int | None,
        command: Twist | Pwm,
        acted: float | None,
        refusal: str | None,
        now: float,
    ) -> None:
        """Note a judged command; `acted` is its proof's, `now` the robot's clock in seconds."""
        if self._file is None:
            return
        if self._ration.more:
            self._settle(now)
        event, news = (
            self._refuse(source, sender, refusal, now)
            if refusal
            else self._accept(source, sender, acted, now)
        )
        if news or self._all:
            values = {"source": source, "sender": "" if sender is None else f"{sender:x}", "command": command}
            self._put(event, now, values | ({"why": refusal} if refusal else {}))

    def event(self, name: str, **values: object) -> None:
        """Note a start, a stop, a change of state."""
        self._put(name, clock.now(), values)

    def close(self) -> None:
        """Write what waits, within a second at most."""
        self._settle(float("inf"))
        if self._file:
            self._file.close()
        self._look()

    def _accept(self, source: str, sender: int | None, acted: float | None, now: float) -> tuple[str, bool]:
        refused = self._refused.get(source)
        if refused and refused.sender == sender:
            refused.why = None  # the same refusal is news again
        last = self._accepted.get(sender) or self._meet(sender)
        away, acts = now - last.at >= AWAY, acted != last.acted
        last.acted, last.at = acted, now
        return "act" if acts and not away else "accepted", (away or acts) and self._ration.spend(now)

    def _meet(self, sender: int | None) -> Accepted:
        if len(self._accepted) >= SENDERS:
            del self._accepted[next(iter(self._accepted))]
        return self._accepted.setdefault(sender, Accepted(None, float("-inf")))

    def _refuse(self, source: str, sender: int | None, why: str, now: float) -> tuple[str, bool]:
        last = self._refused.get(source)
        news = not last or ((last.sender, last.why) != (sender, why) and now - last.at >= 1.0)
        if news:
            self._refused[source] = Refused(sender, why, now)
        return "refused", news

    def _settle(self, now: float) -> None:
        """Say how many acts did not fit into a second that is over."""
        if more := self._ration.settle(now):
            self._put("more", clock.now(), {"count": more})

    def _put(self, event: str, at: float, values: dict[str, Any]) -> None:
        if self._file:
            self._file.put(Entry(clock.stamp(), at, event, values))
            self._look()

    def _look(self) -> None:
        """Warn from the caller's thread; the callback need not be safe in the file's."""
        if self._file and self._file.trouble and not self._warned:
            self._warned = True
            self._warn(f"the journal cannot be kept: {self._file.trouble}")


class Ration:
    """So many lines a second; what exceeds them is counted."""

    def __init__(self) -> None:
        self._since = float("-inf")
        self._used = 0
        self.more = 0

    def spend(self, now: float) -> bool:
        """Say whether one more line fits."""
        if now - self._since >= 1.0:
            self._since, self._used = now, 0
        self._used += 1
        self.more += self._used > ACTS
        return self._used <= ACTS

    def settle(self, now: float) -> int:
        """Return how many did not fit, once their second is over."""
        more = self.more if now - self._since >= 1.0 else 0
        self.more -= more
        return more
