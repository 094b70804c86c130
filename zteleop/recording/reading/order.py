"""Messages in the order in which they arrived, of chunks whose times may overlap."""

from collections.abc import Callable, Iterable, Iterator
from heapq import heappop, heappush, heapreplace

from zteleop.recording.reading import stretch
from zteleop.recording.reading.block import Block, load
from zteleop.recording.reading.contents import Kept
from zteleop.recording.reading.records import BrokenError
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.stretch import LATEST, Wanted

MOST = 2**29
"""bytes of chunks that are open together, because their times overlap"""
_NUMBER = 10
"""bytes for each channel in the index of a chunk"""


def in_order(
    source: Source, blocks: Iterable[Block], wanted: Wanted, note: Callable[[str], None]
) -> Iterator[Kept]:
    """Yield messages as they arrived; `note` is told what is wrong."""
    merge = _Merge()
    for block in sorted(filter(_wanted_in(wanted), blocks), key=_begins):
        yield from merge.until(block.begins)
        if merge.held > MOST:
            note("its chunks overlap so much that its messages do not come in order")
            yield from merge.until(LATEST)
        try:
            data, wrong = load(source, block)
        except BrokenError as error:
            note(str(error))
            continue
        found = stretch.read(data, block.directory, wanted)
        if wrong or found.wrong:
            note(wrong or found.wrong)
        for run in found.runs:
            merge.add(stretch.messages(data, run), len(data))
    yield from merge.until(LATEST)


def _wanted_in(wanted: Wanted) -> Callable[[Block], bool]:
    """Return what says whether a block may have messages that are asked for."""
    numbers: dict[int, set[int]] = {}

    def may(block: Block) -> bool:
        if block.ends < wanted.begin or block.begins >= wanted.end:
            return False
        if wanted.topics is None or not block.numbers:
            return True
        if id(block.directory) not in numbers:
            numbers[id(block.directory)] = block.directory.numbers(wanted.topics)
        own = numbers[id(block.directory)]
        pieces = (block.numbers[at : at + 2] for at in range(0, len(block.numbers), _NUMBER))
        return any(int.from_bytes(piece, "little") in own for piece in pieces)

    return may


def _begins(block: Block) -> int:
    return block.begins


class _Merge:
    """Runs of messages, of which the earliest message comes first; of two, that of the earlier run."""

    def __init__(self) -> None:
        self.held = 0
        """bytes that the runs are read from"""
        self._runs = 0
        self._heap: list[tuple[int, int, Kept, Iterator[Kept], int]] = []

    def add(self, run: Iterator[Kept], size: int) -> None:
        for first in run:
            heappush(self._heap, (first.at, self._runs, first, run, size))
            self._runs += 1
            self.held += size
            return

    def until(self, end: int) -> Iterator[Kept]:
        """Yield what arrived up to a time."""
        heap = self._heap
        while heap and heap[0][0] <= end:
            _, number, kept, run, size = heap[0]
            yield kept
            if following := next(run, None):
                heapreplace(heap, (following.at, number, following, run, size))
            else:
                heappop(heap)
                self.held -= size
