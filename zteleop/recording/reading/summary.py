"""What the end of a file says is in it; of a file of any size it is read in no time."""

from typing import NamedTuple

from zteleop.recording.reading import records
from zteleop.recording.reading.contents import Channel
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.records import (
    FOOTER_LENGTH,
    HEAD,
    MAGIC,
    AttachmentIndex,
    BrokenError,
    ChunkIndex,
    Statistics,
)
from zteleop.recording.reading.source import Source

FOOT = HEAD.size + FOOTER_LENGTH + len(MAGIC)
"""bytes at the end of a file"""
NO_END = "it has no end, as if it was cut off"


class Summary(NamedTuple):
    statistics: Statistics
    directory: Directory
    chunks: list[ChunkIndex]
    attachments: list[AttachmentIndex]
    metadata: list[int]
    """where these are"""

    @property
    def channels(self) -> dict[int, Channel]:
        counts = self.statistics.counts
        return {
            number: channel._replace(messages=counts.get(number, 0))
            for number, channel in self.directory.channels.items()
        }


def read(source: Source) -> Summary | None:
    """Return what the end of a file says; None where it says nothing, or not enough.

    Raises BrokenError where there is no end, or it cannot be true.
    """
    if source.size < len(MAGIC) + FOOT or source.read(source.size - len(MAGIC), len(MAGIC)) != MAGIC:
        raise BrokenError(NO_END)
    at = source.size - FOOT
    starts = records.footer(source.record(at, records.FOOTER))
    if not starts:
        return None
    if not len(MAGIC) <= starts <= at:
        raise BrokenError("its end says that its summary is where none can be")
    found = _Summary(source.read(starts, at - starts)).summary()
    if found:
        _check(found, source.size)
    return found


class _Summary:
    def __init__(self, data: bytes) -> None:
        self._directory = Directory()
        self._statistics: Statistics | None = None
        self._chunks: list[ChunkIndex] = []
        self._attachments: list[AttachmentIndex] = []
        self._metadata: list[int] = []
        at = 0
        while at < len(data):
            at = self._take(data, at)

    def summary(self) -> Summary | None:
        told = self._statistics
        if told is None or not told.counts.keys() <= self._directory.channels.keys():
            return None  # some writers do not repeat their channels
        if (told.attachments, told.metadata) != (len(self._attachments), len(self._metadata)):
            return None
        if self._directory.lacks_schemas():
            return None
        return Summary(told, self._directory, self._chunks, self._attachments, self._metadata)

    def _take(self, data: bytes, at: int) -> int:
        body = at + HEAD.size
        if body > len(data):
            raise BrokenError("its summary is cut off")
        kind, length = HEAD.unpack_from(data, at)
        after: int = body + length
        if after > len(data):
            raise BrokenError("its summary goes past its end")
        record = data[body:after]
        if kind == records.SCHEMA:
            self._directory = self._directory.with_schema(record)
        elif kind == records.CHANNEL:
            self._directory = self._directory.with_channel(record)
        elif kind == records.STATISTICS:
            self._statistics = records.statistics(record)
        elif kind == records.CHUNK_INDEX:
            self._chunks.append(records.chunk_index(record))
        elif kind == records.ATTACHMENT_INDEX:
            self._attachments.append(records.attachment_index(record))
        elif kind == records.METADATA_INDEX:
            self._metadata.append(records.metadata_index(record)[0])
        return after


def _check(found: Summary, size: int) -> None:
    """Raise BrokenError where a summary cannot be true."""
    told = found.statistics
    if sum(told.counts.values()) != told.messages or told.begins > told.ends:
        raise BrokenError("its summary contradicts itself")
    if found.chunks and len(found.chunks) != told.chunks:
        raise BrokenError("its summary does not tell of all its chunks")
    if any(index.at + index.length > size or index.begins > index.ends for index in found.chunks):
        raise BrokenError("its summary tells of chunks that cannot be there")
    if any(index.at + index.length > size for index in found.attachments):
        raise BrokenError("its summary tells of attachments that cannot be there")
