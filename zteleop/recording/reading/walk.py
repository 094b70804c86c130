"""A file looked through from its first byte to its last, whatever its end says, or where there is none.

Where what follows makes no sense, such as a length that lies, it goes on with the next that does.
"""

from zteleop.recording import amounts
from zteleop.recording.reading import records, stretch
from zteleop.recording.reading.block import HEAD_LENGTH, Block, load, of_chunk
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.findings import Findings
from zteleop.recording.reading.landmark import Landmarks
from zteleop.recording.reading.records import HEAD, MAGIC, BrokenError, Fields
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.unpacking import LARGEST

WINDOW = 2**22
"""bytes of records side by side that are read at once"""
_SIDE_BY_SIDE = (records.SCHEMA, records.CHANNEL, records.MESSAGE)
_TOLD_AGAIN = (
    records.FOOTER,
    records.MESSAGE_INDEX,
    records.CHUNK_INDEX,
    records.ATTACHMENT_INDEX,
    records.STATISTICS,
    records.METADATA_INDEX,
    records.SUMMARY_OFFSET,
    records.DATA_END,
)
"""kinds of records that say nothing new: it is no loss where they are cut off"""
_HEADER_LENGTH = 2**16
_CRC = 4
"""bytes after an attachment"""


def walk(source: Source) -> Findings:
    """Return what is found on the way through a file."""
    return _Walk(source).go()


class _Walk:
    def __init__(self, source: Source) -> None:
        self._source = source
        self._landmarks = Landmarks(source)
        self._found = Findings()

    def go(self) -> Findings:
        at = 0
        while at < self._source.size:
            at = self._step(at)
        return self._found

    def _step(self, at: int) -> int:
        """Take in what is at a place; return where to go on."""
        self._found.finished = False
        if self._source.some(at, len(MAGIC)) == MAGIC:
            self._found.finished = True
            return at + len(MAGIC)
        try:
            kind, length = self._source.head(at)
            if kind in _SIDE_BY_SIDE:
                return self._stretch(at, length)
            if kind == records.CHUNK:
                return self._chunk(at, length)
            sure = self._other(at, kind, length)
        except BrokenError as error:
            return self._found.lose(at, self._next(at + 1), str(error))
        return self._on(at + HEAD.size + length, sure)

    def _on(self, end: int, sure: int) -> int:
        """Return where to go on after a record that says to end at a place, and surely goes to another."""
        if end >= sure and self._landmarks.plausible(end):
            return end
        found = self._next(sure)
        if end > self._source.size == found:
            return found
        if found < end:
            self._found.lies += 1
        return self._found.lose(end if found >= end else sure, found, "what follows a record is none")

    def _next(self, start: int) -> int:
        found = self._landmarks.next(start, self._found.directory)
        return self._source.size if found is None else found

    def _stretch(self, at: int, length: int) -> int:
        """Take in records side by side."""
        size = max(WINDOW, HEAD.size + length)
        if size > LARGEST:
            raise BrokenError(f"a record of {length} bytes; at most {LARGEST} are read")
        data = self._source.some(at, size)
        found = stretch.read(data, self._found.directory, only_known=True)
        if not found.end:
            raise BrokenError(found.wrong)
        end = after = at + found.end
        if not self._landmarks.plausible(end):
            after = self._next(at + found.last + 1)
            if after < self._source.size:  # of the last one not even the length is sure
                end = at + found.last
                found = stretch.read(data[: found.last], self._found.directory)
        self._found.take(Block(at, end - at, "", end - at, 0, 0, 0, self._found.directory), found)
        return self._found.lose(end, after, found.wrong)

    def _chunk(self, at: int, length: int) -> int:
        """Take in a chunk; of the two lengths that it says, that counts after which something follows."""
        head = records.chunk_head(self._source.some(at + HEAD.size, HEAD_LENGTH))
        block, end = of_chunk(at, head, self._found.directory), at + HEAD.size + length
        most = self._source.size
        if block.at < end < most and self._landmarks.plausible(end):
            most = end
        cut = block.at + block.length > most
        if cut:
            block = block._replace(length=min(most - block.at, LARGEST))
        data, wrong = load(self._source, block)
        found = stretch.read(data, self._found.directory)
        if not head.packing and (cut or found.wrong):
            self._found.lies += 1
            return block.at  # what is in it is looked through as if there was no chunk
        self._found.chunks += 1
        self._found.take(block, found)
        if wrong or found.wrong:
            had = amounts.count(sum(len(run.times) for run in found.runs), "message")
            words = "a chunk is cut off" if cut else wrong or found.wrong
            self._found.damaged.append(f"{words}: {had} of it could be had")
        if cut and most == end:
            self._found.lies += 1
            return end
        return self._next(block.at) if cut else self._on(end, block.at + block.length)

    def _other(self, at: int, kind: int, length: int) -> int:
        """Take in a record that has no messages in it; return up to where it surely goes."""
        body = at + HEAD.size
        if kind == records.HEADER:
            self._begin(self._source.read(body, min(length, _HEADER_LENGTH)))
        elif kind == records.ATTACHMENT:
            head = records.attachment_head(self._source.read(body, min(length, _HEADER_LENGTH)))
            body += head.starts + head.length + _CRC
            if body > self._source.size:
                raise BrokenError("an attachment is cut off")
            self._found.attachments.append(at)
        elif kind == records.METADATA:
            fields = Fields(self._source.read(body, min(length, LARGEST)))
            fields.text(), fields.pairs()
            body += fields.at
            self._found.metadata.append(at)
        elif not kind or (body + length > self._source.size and kind not in _TOLD_AGAIN):
            raise BrokenError("a record is cut off" if kind else "there is no record")
        return body

    def _begin(self, header: bytes) -> None:
        profile, library = records.header(header)
        if not self._found.profile and not self._found.library:
            self._found.profile, self._found.library = profile, library
        if self._found.blocks:  # another recording was written behind the first one
            self._found.directory = Directory()
