"""One MCAP file, read: what is in it, and its messages in the order in which they arrived.

A file that was cut off, such as by a flat battery, is read as far as it goes.
"""

import zlib
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from zteleop.recording.reading import records, summary
from zteleop.recording.reading.block import Block, of_index
from zteleop.recording.reading.contents import Attachment as Attachment
from zteleop.recording.reading.contents import Channel as Channel
from zteleop.recording.reading.contents import Contents as Contents
from zteleop.recording.reading.contents import Kept as Kept
from zteleop.recording.reading.findings import Findings
from zteleop.recording.reading.order import in_order
from zteleop.recording.reading.other_files import check
from zteleop.recording.reading.records import HEAD, MAGIC, AttachmentHead, BrokenError
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.stretch import LATEST, Wanted
from zteleop.recording.reading.summary import Summary
from zteleop.recording.reading.walk import walk

MENDED = "zteleop bag recover mends it"
MOST_TROUBLES = 5
"""that are told of one file"""
HEADS = 2**16
"""bytes of an attachment that are read for its name"""
CRC = 4


class BagFile:
    """A file, in a `with`; raises RecordingError when it holds no recording."""

    def __init__(self, path: Path, thorough: bool = False) -> None:
        """With `thorough` what is said at its end is not believed: all of it is looked through."""
        self.path = path
        self.troubles: list[str] = []
        """what is wrong with it, in words; what could be read was"""
        self._thorough = thorough
        self._contents: Contents | None = None
        self._summary: Summary | None = None
        self._walk: Findings | None = None
        self._source = Source(path)
        try:
            check(self._source, thorough)
        except BaseException:
            self._source.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._source.close()

    @property
    def size(self) -> int:
        """Bytes."""
        return self._source.size

    @property
    def trouble(self) -> str:
        """What is wrong with it, in words; empty where nothing is."""
        return "; ".join([*self.troubles, MENDED]) if self.troubles else ""

    @property
    def intact(self) -> bool:
        """Nothing is missing, and its end says of all of it what is true."""
        try:
            told = summary.read(self._source)
        except BrokenError:
            return False
        if told is None or not self.walk.whole:
            return self.walk.whole  # an end need not say anything
        return _gist(self._told(told)) == _gist(self._found())

    @property
    def walk(self) -> Findings:
        """What was found on the way through all of it."""
        if self._walk is None:
            self._walk = walk(self._source)
            for words in self._walk.losses(self.size):
                self._note(words)
        return self._walk

    @property
    def contents(self) -> Contents:
        """What is in it; of a file without a summary all is read for that."""
        if self._contents is None:
            self._summary = None if self._thorough else self._read_summary()
            self._contents = self._told(self._summary) if self._summary else self._found()
        return self._contents

    def messages(
        self, topics: Collection[str] | None = None, begin: int | None = None, end: int | None = None
    ) -> Iterator[Kept]:
        """Yield messages as they arrived: of some topics, from a time on and before another, in ns."""
        wanted = Wanted(topics, begin or 0, LATEST if end is None else end)
        yield from in_order(self._source, self._blocks(), wanted, self._note)

    def attachments(self) -> Iterator[Attachment]:
        """Yield what else is in it."""
        for at in self._places(records.ATTACHMENT):
            try:
                yield self._attachment(at)
            except BrokenError as error:
                self._note(f"an attachment cannot be read: {error}")

    def heads(self) -> Iterator[AttachmentHead]:
        """Yield what the attachments are called, and how long they are."""
        for at in self._places(records.ATTACHMENT):
            with suppress(BrokenError):
                yield self._attachment_head(at)

    def notes(self) -> Iterator[tuple[str, dict[str, str]]]:
        """Yield what is said of it, each under a name, which may be said twice."""
        for at in self._places(records.METADATA):
            try:
                yield records.metadata(self._source.record(at, records.METADATA))
            except BrokenError as error:
                self._note(f"what is said of it cannot be read: {error}")

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return what is said of it, by name."""
        return dict(self.notes())

    def _places(self, kind: int) -> list[int]:
        """Return where attachments or metadata are."""
        self.contents  # noqa: B018  which reads the summary
        if self._summary is None:
            return self.walk.attachments if kind == records.ATTACHMENT else self.walk.metadata
        if kind == records.ATTACHMENT:
            return [index.at for index in self._summary.attachments]
        return self._summary.metadata

    def _attachment_head(self, at: int) -> AttachmentHead:
        kind, length = self._source.head(at)
        if kind != records.ATTACHMENT:
            raise BrokenError(f"at byte {at} there is none")
        return records.attachment_head(self._source.some(at + HEAD.size, min(length, HEADS)))

    def _attachment(self, at: int) -> Attachment:
        head, record = self._attachment_head(at), self._source.record(at, records.ATTACHMENT)
        data = record[head.starts : head.starts + head.length]
        told = record[head.starts + head.length :][:CRC]
        if len(data) < head.length:
            raise BrokenError(f"it says to be {head.length} bytes long, and is not")
        crc = int.from_bytes(told, "little")
        if crc and crc != zlib.crc32(record[: head.starts + head.length]):
            self._note(f"the attachment {head.name} has changed since it was written, as its checksum tells")
        return Attachment(head.name, head.media_type, head.at, data, head.created)

    def _blocks(self) -> Iterator[Block]:
        """Yield where its messages are."""
        contents, told = self.contents, self._summary
        if told is None or (contents.messages and not told.chunks):
            yield from self.walk.blocks
            return
        for index in told.chunks:
            try:
                yield of_index(self._source, index, told.directory)
            except BrokenError as error:
                self._note(str(error))

    def _read_summary(self) -> Summary | None:
        """Return what the end of the file says of it; None where it was cut off, or lies."""
        try:
            return summary.read(self._source)
        except BrokenError as error:
            self._note(str(error))
            return None

    def _told(self, told: Summary) -> Contents:
        found, (profile, library) = told.statistics, self._header()
        kinds = tuple(sorted({index.packing or "none" for index in told.chunks}))
        return Contents(profile, library, told.channels, found.chunks, kinds, found.begins, found.ends, True)

    def _found(self) -> Contents:
        found = self.walk
        kinds = tuple(sorted({block.packing or "none" for block in found.blocks})) if found.chunks else ()
        begins = min((block.begins for block in found.blocks), default=0)
        ends = max((block.ends for block in found.blocks), default=0)
        channels = dict(enumerate(found.channels))
        return Contents(found.profile, found.library, channels, found.chunks, kinds, begins, ends, False)

    def _header(self) -> tuple[str, str]:
        with suppress(BrokenError):
            return records.header(self._source.record(len(MAGIC), records.HEADER))
        return "", ""

    def _note(self, words: str) -> None:
        if words not in self.troubles and len(self.troubles) < MOST_TROUBLES:
            self.troubles.append(words)


def _gist(contents: Contents) -> object:
    """Return what two ways to find out what is in a file must agree on."""
    counts = {channel.key: channel.messages for channel in contents.channels.values()}
    return counts, contents.begins, contents.ends
