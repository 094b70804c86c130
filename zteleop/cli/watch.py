import argparse
import shutil
import sys
from collections import deque
from collections.abc import Iterable
from contextlib import suppress

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve
from zteleop.bus.presence import Endpoint
from zteleop.cli import _company, _options
from zteleop.cli._listening import Arrival, Listening, listening
from zteleop.errors import ConfigError
from zteleop.recording.amounts import size

EXAMPLES = (
    "zteleop watch",
    "zteleop watch --robot archangel",
)
EVERY = 1.0
"""s between two tables"""
RECENT = 5.0
"""s of messages that make a rate"""
NEWEST = 10_000
"""messages of a topic that are remembered"""
MOST = 200
"""topics that are heard at once; a stranger may name any number"""
HEAD = ("topic", "rate", "bandwidth", "last", "said by", "type")
HOME, REST_OF_LINE, REST_OF_SCREEN = "\x1b[H", "\x1b[K", "\x1b[J"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)


def run(arguments: argparse.Namespace) -> None:
    with listening("watch", [], arguments, settle=True) as (ears, _):
        ears.patient = False
        watched = Watched(ears, _options.load(arguments).robot)

        def show() -> None:
            watched.look()
            draw(watched.lines(clock.now()))

        ears.loop.every(EVERY, show)
        ears.run()


class Traffic:
    """What is said on a topic, and when."""

    def __init__(self) -> None:
        self._newest: deque[tuple[float, int]] = deque(maxlen=NEWEST)

    def hear(self, arrival: Arrival) -> None:
        self._newest.append((arrival.at, len(arrival.sample.payload)))

    def cells(self, now: float) -> tuple[str, str, str]:
        """Return rate, bandwidth and the age of the last message, in words."""
        if not self._newest:
            return "", "", "nothing yet"
        age = f"{now - self._newest[-1][0]:.1f} s ago"
        while len(self._newest) > 1 and now - self._newest[0][0] > RECENT:
            self._newest.popleft()
        first, last = self._newest[0][0], self._newest[-1][0]
        if last <= first:
            return "", "", age
        rate_hz = (len(self._newest) - 1) / (last - first)
        mean = sum(length for _, length in self._newest) / len(self._newest)
        return f"{rate_hz:.1f} Hz", f"{size(round(rate_hz * mean))}/s", age


class Watched:
    """Every topic that somebody publishes, of one robot or of all."""

    def __init__(self, ears: Listening, robot: str | None) -> None:
        self._ears = ears
        self._robot = robot
        self._topics: dict[str, list[Endpoint]] = {}
        self._others: set[str] = set()
        self._traffic: dict[str, Traffic] = {}

    def look(self) -> None:
        """Hear what has come, and forget what has gone."""
        everybody = [one for one in self._ears.endpoints() if one.kind == "pub"]
        self._others = {one.robot for one in everybody}
        said = [one for one in everybody if self._robot in (None, one.robot)]
        self._topics = _company.by_topic(said)
        for topic in self._topics:
            if topic not in self._traffic and len(self._traffic) < MOST:
                self._hear(topic)

    def _hear(self, topic: str) -> None:
        with suppress(ConfigError):  # a stranger may say that he publishes what is no name
            name = resolve(topic, None)
            self._traffic[topic] = Traffic()
            self._ears.hear(name, self._traffic[topic].hear)

    def lines(self, now: float) -> list[str]:
        """Return a table of what is said now, or who is missing."""
        if not self._topics:
            where = self._robot or "a robot"
            unreached = self._ears.unreached()
            here = presence.who_is_here(self._others, self._robot or "", unreached)
            start = "start one with: zteleop demo, or zteleop actuator"
            return [f"nobody speaks for {where}; {here if self._others or unreached else start}"]
        rows = [HEAD, *(self._row(topic, members, now) for topic, members in self._topics.items())]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]

    def _row(self, topic: str, members: list[Endpoint], now: float) -> tuple[str, ...]:
        traffic = self._traffic.get(topic)
        cells = traffic.cells(now) if traffic else ("", "", "not heard")
        nodes = sorted({member.node for member in members})
        types = sorted({member.type for member in members})
        return (topic, *cells, ", ".join(nodes), ", ".join(types))


def draw(lines: Iterable[str]) -> None:
    """Show lines in the place of those before, in a terminal; else below them."""
    lines = [printable(line) for line in lines]
    if not sys.stdout.isatty():
        print("\n".join(lines), end="\n\n", flush=True)
        return
    columns, rows = shutil.get_terminal_size()
    lines = [*lines[: rows - 3], "", "Ctrl-C ends"]
    shown = "\r\n".join(f"{line[: columns - 1]}{REST_OF_LINE}" for line in lines[: rows - 1])
    print(f"{HOME}{shown}{REST_OF_SCREEN}", end="", flush=True)
