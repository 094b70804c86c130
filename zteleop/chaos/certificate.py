"""What was shown: each fault, how often, how long the wheels turned on, and the verdict."""

import os
import platform
import statistics
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version

from msgspec import Struct

from zteleop.chaos.fault import Fault
from zteleop.chaos.trial import Outcome

HEAD = f"{'fault':36} {'times':>5} {'median':>9} {'worst':>9} {'bound':>9}"


class Verdict(Struct, frozen=True):
    """One fault, all its trials; times in seconds until rest, None where there are none.

    A void trial was later than its bound by no more than its processes waited for a core: it shows
    what the machine did, and counts neither way.
    """

    fault: str
    kind: str
    times: int
    median: float | None
    worst: float | None
    bound: float | None
    then: str
    broken: list[str]
    notes: list[str]
    void: int = 0
    longest_wait: float = 0.0

    @property
    def kept(self) -> bool:
        return not self.broken and self.times > 0

    @property
    def word(self) -> str:
        """Return the verdict in a word, and how many trials were void."""
        word = "BROKEN" if self.broken else "kept" if self.kept else "NOT JUDGED"
        return f"{word}, {self.void} void" if self.void else word

    def line(self) -> str:
        """Return the line of a table."""
        figures = " ".join(_ms(seconds) for seconds in (self.median, self.worst, self.bound))
        return f"{self.fault:36} {self.times:5} {figures}  {self.word}"


class Certificate(Struct, frozen=True):
    """All verdicts, of what, where and when."""

    robot: str
    zteleop: str
    machine: str
    date: str
    verdicts: list[Verdict]
    left_out: list[str]

    @property
    def kept(self) -> bool:
        return all(verdict.kept for verdict in self.verdicts)

    def summary(self) -> str:
        """Return the lines under the table."""
        kept, trials = sum(v.kept for v in self.verdicts), sum(v.times for v in self.verdicts)
        lines = [f"{kept} of {len(self.verdicts)} faults kept, {trials} trials", *self._waits()]
        if self.left_out:
            lines.append(f"left out, for they need a simulated chip: {', '.join(self.left_out)}")
        lines += [f"{v.fault}: {words}" for v in self.verdicts for words in (*v.broken, *v.notes)]
        lines += [f"{self.robot}, zteleop {self.zteleop}, {self.machine}, {self.date}"]
        return "\n".join(lines)

    def _waits(self) -> list[str]:
        """Return what the machine did, where it was so busy that it mattered."""
        if not (void := sum(v.void for v in self.verdicts)):
            return []
        longest = max(v.longest_wait for v in self.verdicts)
        words = f"void trials: {void}, late only because their processes waited for a core"
        return [f"{words} (longest wait {longest * 1000:.1f} ms)"]


def verdict(kind: str, fault: Fault, outcomes: Sequence[Outcome]) -> Verdict:
    """Judge one fault by all its trials."""
    judged = [
        outcome for outcome in outcomes if outcome.broken or outcome.verdict(fault.bound) != "not judged"
    ]
    seconds = [outcome.seconds for outcome in judged if outcome.seconds is not None]
    broken = [outcome.broken for outcome in outcomes if outcome.broken]
    worst = max(seconds, default=None)
    if worst is not None and fault.bound is not None and worst > fault.bound:
        broken.append(f"it took {worst * 1000:.1f} ms until rest")
    return Verdict(
        fault=fault.name,
        kind=kind,
        times=len(judged),
        median=statistics.median(seconds) if seconds else None,
        worst=worst,
        bound=fault.bound,
        then=fault.then,
        broken=list(dict.fromkeys(broken)),
        notes=list(dict.fromkeys(note for outcome in outcomes for note in outcome.notes)),
        void=len(outcomes) - len(judged),
        longest_wait=max((outcome.waited for outcome in outcomes), default=0.0),
    )


def certify(robot: str, verdicts: list[Verdict], left_out: list[str]) -> Certificate:
    """Put the verdicts together, with the machine and the day."""
    system = f"{platform.system()} {platform.release()} {platform.machine()}"
    machine = f"{system}, {os.cpu_count()} cores, Python {platform.python_version()}"
    day = datetime.now(UTC).strftime("%Y-%m-%d")
    return Certificate(robot, version("zteleop"), machine, day, verdicts, left_out)


def _ms(seconds: float | None) -> str:
    return f"{'-':>9}" if seconds is None else f"{seconds * 1000:6.1f} ms"
