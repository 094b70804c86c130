"""What was found in a file that was looked through, and what was not, in words."""

from collections import Counter
from collections.abc import Iterator
from typing import NamedTuple

from zteleop.recording import amounts
from zteleop.recording.reading.block import Block
from zteleop.recording.reading.contents import Channel
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.stretch import Stretch

MOST_TOLD = 3
"""of gaps, and of chunks that are damaged"""


class Gap(NamedTuple):
    """Bytes that could not be read."""

    at: int
    length: int
    why: str


class Findings:
    """Grows while a file is looked through."""

    def __init__(self) -> None:
        self.profile = ""
        self.library = ""
        self.blocks: list[Block] = []
        self.chunks = 0
        self.attachments: list[int] = []
        """where they are in the file"""
        self.metadata: list[int] = []
        self.gaps: list[Gap] = []
        self.damaged: list[str] = []
        """what is wrong with each chunk that could not be read to its end"""
        self.lies = 0
        """records that say a wrong length, of which nothing is lost"""
        self.finished = False
        """The last thing in it is its end."""
        self.directory = Directory()
        """what is known so far"""
        self._counts: list[tuple[Directory, Counter[int]]] = []

    @property
    def whole(self) -> bool:
        """Nothing is missing that the file had once."""
        return self.finished and not (self.gaps or self.damaged or self.lies or self.nameless)

    @property
    def channels(self) -> list[Channel]:
        """Every channel that is described, with the number of its messages."""
        found: dict[object, Channel] = {}
        for directory, counts in self._counts or [(self.directory, Counter())]:
            for number, channel in directory.channels.items():
                messages = counts[number] + (found[channel.key].messages if channel.key in found else 0)
                found[channel.key] = channel._replace(messages=messages)
        return list(found.values())

    @property
    def nameless(self) -> int:
        """Messages of channels that nobody has described."""
        return sum(
            count
            for directory, counts in self._counts
            for number, count in counts.items()
            if number not in directory.channels
        )

    def take(self, block: Block, found: Stretch) -> None:
        """Remember where messages are, how many, and what is known after them."""
        self.directory = found.directory
        if found.runs:
            self.blocks.append(block._replace(begins=found.begins, ends=found.ends))
        for run in found.runs:
            if not self._counts or self._counts[-1][0] is not run.directory:
                self._counts.append((run.directory, Counter()))
            self._counts[-1][1].update(run.numbers)

    def lose(self, at: int, end: int, why: str) -> int:
        """Remember that bytes could not be read; return where they end."""
        if at < end:
            self.gaps.append(Gap(at, end - at, why))
        return end

    def losses(self, size: int) -> Iterator[str]:
        """Yield in words what could not be read of a file that is so long."""
        for at, length, why in self.gaps[:MOST_TOLD]:
            if at + length == size:
                yield f"what stands at its end, {amounts.count(length, 'byte')}, was cut off"
            else:
                yield f"{amounts.count(length, 'byte')} from byte {at} on make no sense ({why})"
        if len(self.gaps) > MOST_TOLD:
            lost = sum(gap.length for gap in self.gaps[MOST_TOLD:])
            yield f"{amounts.count(lost, 'byte')} in {len(self.gaps) - MOST_TOLD} more places make none"
        yield from self.damaged[:MOST_TOLD]
        if len(self.damaged) > MOST_TOLD:
            yield f"{amounts.count(len(self.damaged) - MOST_TOLD, 'more chunk')} damaged"
        if self.nameless:
            yield f"{amounts.count(self.nameless, 'message')} of channels that it does not describe"
