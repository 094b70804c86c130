"""Records side by side, as they are in a chunk that is unpacked, or in a file without chunks."""

from array import array
from collections.abc import Collection, Iterator
from itertools import islice
from operator import le
from typing import NamedTuple

from zteleop.recording.reading import records
from zteleop.recording.reading.contents import Kept
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.records import HEAD, MESSAGE, MESSAGE_HEAD, BrokenError

LATEST = 2**64


class Run(NamedTuple):
    """Messages that one directory explains: of which channels, when they arrived, and where they are."""

    directory: Directory
    numbers: "array[int]"
    times: "array[int]"
    places: "array[int]"


class Wanted(NamedTuple):
    """Which messages are asked for: of some topics, or all, from a time on and before another."""

    topics: Collection[str] | None = None
    begin: int = 0
    end: int = LATEST


class Stretch(NamedTuple):
    """What was found in some bytes."""

    runs: list[Run]
    directory: Directory
    """what is known after them"""
    end: int
    """where the last whole record ends"""
    last: int
    """where that record begins"""
    wrong: str
    """why they end before the bytes do; empty where they do not"""

    @property
    def begins(self) -> int:
        return min((min(run.times) for run in self.runs), default=0)

    @property
    def ends(self) -> int:
        return max((max(run.times) for run in self.runs), default=0)


def read(
    data: bytes, directory: Directory, wanted: Wanted | None = None, only_known: bool = False
) -> Stretch:
    """Look through records for messages, of channels that may be described only later where all are wanted.

    With `only_known` another kind of record than a message, a schema or a channel ends them.
    """
    return _Reading(data, directory, wanted or Wanted(), only_known).go()


def messages(data: bytes, run: Run) -> Iterator[Kept]:
    """Yield the messages of a run as they arrived, but for those of channels that nobody has described."""
    channels, places, take = run.directory.channels, run.places, MESSAGE_HEAD.unpack_from
    for index in _order(run.times):
        place = places[index]
        number, sequence, at, published = take(data, place)
        if channel := channels.get(number):
            length = HEAD.unpack_from(data, place - HEAD.size)[1]
            yield Kept(channel, at, published, sequence, data[place + MESSAGE_HEAD.size : place + length])


def _order(times: "array[int]") -> "range | list[int]":
    if all(map(le, times, islice(times, 1, None))):
        return range(len(times))
    return sorted(range(len(times)), key=times.__getitem__)


class _Reading:
    def __init__(self, data: bytes, directory: Directory, wanted: Wanted, only_known: bool) -> None:
        self._data = data
        self._wanted = wanted
        self._only_known = only_known
        self._at = 0
        self._last = 0
        self._runs: list[Run] = []
        self._asked: dict[int, bool] = {}
        self._turn(directory)

    def go(self) -> Stretch:
        wrong = ""
        try:
            while self._at < len(self._data):
                self._messages()
                if self._at < len(self._data):
                    self._other()
        except BrokenError as error:
            wrong = str(error)
        runs = [run for run in self._runs if run.times]
        return Stretch(runs, self._directory, self._at, self._last, wrong)

    def _turn(self, directory: Directory) -> None:
        """Let what follows be explained by a directory."""
        self._directory = directory
        self._run = Run(directory, array("H"), array("Q"), array("Q"))
        self._runs.append(self._run)
        self._asked.clear()

    def _messages(self) -> None:
        """Take in messages up to another record."""
        data, run, asked = self._data, self._run, self._asked
        _, begin, end = self._wanted
        while self._at < len(data):
            kind, body, after = self._head(self._at)
            if kind != MESSAGE:
                return
            if after - body < MESSAGE_HEAD.size:
                raise BrokenError(f"a message says to be {after - body} bytes long, which none is")
            number, _, at, _ = MESSAGE_HEAD.unpack_from(data, body)
            if begin <= at < end and (asked[number] if number in asked else self._ask(number)):
                run.numbers.append(number)
                run.times.append(at)
                run.places.append(body)
            self._last, self._at = self._at, after

    def _ask(self, number: int) -> bool:
        """Say whether messages of a channel are asked for."""
        if self._wanted.topics is None:
            self._asked[number] = True
        elif channel := self._directory.channels.get(number):
            self._asked[number] = channel.topic in self._wanted.topics
        return self._asked.get(number, False)

    def _other(self) -> None:
        """Take in a record that is no message."""
        kind, body, after = self._head(self._at)
        if kind in (records.SCHEMA, records.CHANNEL):
            record = self._data[body:after]
            known = self._directory
            found = known.with_schema(record) if kind == records.SCHEMA else known.with_channel(record)
            if found is not known:
                self._turn(found)
        elif self._only_known or not kind:
            raise BrokenError(f"a record is of the kind {kind}, which belongs elsewhere")
        self._last, self._at = self._at, after

    def _head(self, at: int) -> tuple[int, int, int]:
        """Return what a record is, where what it says begins, and where it ends."""
        body = at + HEAD.size
        if body > len(self._data):
            raise BrokenError("a record is cut off")
        kind, length = HEAD.unpack_from(self._data, at)
        if body + length > len(self._data):
            raise BrokenError(f"a record says to be {length} bytes long, and is not")
        return kind, body, body + length
