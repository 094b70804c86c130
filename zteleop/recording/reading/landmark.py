"""Where a file makes sense again, after a part of it that does not."""

import re

from zteleop.recording.reading import records
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.records import CHUNK, HEAD, MAGIC, MESSAGE, BrokenError, Fields
from zteleop.recording.reading.source import Source

WINDOW = 2**20
GLANCE = 2**12
"""bytes of a record that are looked at"""
_CANDIDATE = re.compile(rb"[\x01-\x0f](?=.{4}\0{4})|" + re.escape(MAGIC), re.DOTALL)
"""a record that says what it is, and to be less than 4 GiB long"""
LONGEST = 2**32
"""bytes that a record may have that was cut off"""
_MARGIN = 16
"""bytes by which windows overlap, so that a candidate is whole in one"""
_INDEXED = 16
"""bytes for each message in an index of them"""


class Landmarks:
    def __init__(self, source: Source) -> None:
        self._source = source

    def next(self, start: int, directory: Directory) -> int | None:
        """Return the first place from a start on at which a record begins that is surely one."""
        for at in range(start, self._source.size, WINDOW):
            window = self._source.some(at, WINDOW + _MARGIN)
            for found in _CANDIDATE.finditer(window, 0):
                if found.start() < WINDOW and self._sure(at + found.start(), directory):
                    return at + found.start()
        return None

    def plausible(self, at: int) -> bool:
        """Say whether a record may begin at a place, or the file ends there."""
        size = self._source.size
        if size - HEAD.size < at <= size or self._source.some(at, len(MAGIC)) == MAGIC:
            return True
        try:
            kind, length = self._source.head(at)
        except BrokenError:
            return False
        if records.HEADER <= kind <= records.DATA_END:
            return length < LONGEST or at + HEAD.size + length <= size
        return kind >= records.PRIVATE and at + HEAD.size + length <= size

    def _sure(self, at: int, directory: Directory) -> bool:
        if self._source.some(at, len(MAGIC)) == MAGIC:
            return True
        try:
            kind, length = self._source.head(at)
            look = self._source.some(at + HEAD.size, min(length, GLANCE))
            fits = _fits(kind, length, look, directory)
        except BrokenError:
            return False
        return fits and (kind == CHUNK or self.plausible(at + HEAD.size + length))


def _fits(kind: int, length: int, look: bytes, directory: Directory) -> bool:
    """Say whether what a record says agrees with its length; raises BrokenError where it cannot be read."""
    fields = Fields(look)
    if kind == MESSAGE:
        return length >= records.MESSAGE_HEAD.size and fields.u16() in directory.channels
    if kind == records.HEADER:
        return bool(fields.text() + fields.text()) and fields.at == length
    if kind == CHUNK:
        head = records.chunk_head(look)
        return head.at + head.length == length
    if kind == records.SCHEMA:
        number, _, _ = fields.u16(), fields.text(), fields.text()
        return number > 0 and fields.u32() + fields.at == length
    if kind == records.CHANNEL:
        found = records.channel(look)
        return "\ufffd" not in found.topic + found.encoding
    if kind == records.MESSAGE_INDEX:
        _, size = fields.u16(), fields.u32()
        return size % _INDEXED == 0 and fields.at + size == length
    if kind == records.ATTACHMENT:
        starts = records.attachment_head(look)
        return starts.starts + starts.length + 4 == length
    if kind == records.METADATA:
        fields.text()
        return fields.u32() + fields.at == length
    return (kind, length) in ((records.DATA_END, 4), (records.FOOTER, records.FOOTER_LENGTH))
