"""The end of an MCAP file: what is in it, and where, so that nobody need read it all to know."""

import struct
import zlib
from collections import Counter
from collections.abc import Iterable

from mcap import records
from mcap.opcode import Opcode

from zteleop.recording.writing.chunk import Pressed, packed

MAGIC = b"\x89MCAP0\r\n"
_FOOTER = struct.Struct("<BQQQ")
_FOOTER_LENGTH = 20


class BagEnd:
    """Notes what is written, each as the record that the end will hold."""

    def __init__(self) -> None:
        self._schemas: list[bytes] = []
        self._channels: list[bytes] = []
        self._chunks: list[bytes] = []
        self._attachments: list[bytes] = []
        self._metadata: list[bytes] = []
        self.counts: Counter[int] = Counter()
        self.messages = 0
        self.begins = 0
        self.ends = 0
        """ns since 1970, of the first message and of the last"""

    def known(self, record: records.Schema | records.Channel) -> None:
        (self._schemas if isinstance(record, records.Schema) else self._channels).append(packed(record))

    def chunk(self, pressed: Pressed) -> None:
        self._chunks.append(pressed.told)
        if pressed.counts:
            self.counts.update(pressed.counts)
            self.messages += sum(pressed.counts.values())
            self.begins = min(self.begins or pressed.begins, pressed.begins)
            self.ends = max(self.ends, pressed.ends)

    def attached(self, record: records.Attachment, offset: int, length: int) -> None:
        created, logged, size = record.create_time, record.log_time, len(record.data)
        index = records.AttachmentIndex(offset, length, created, logged, size, record.name, record.media_type)
        self._attachments.append(packed(index))

    def described(self, name: str, offset: int, length: int) -> None:
        self._metadata.append(packed(records.MetadataIndex(offset, length, name)))

    def text(self, offset: int) -> bytes:
        """Return the end of a file that is so long."""
        data_end = packed(records.DataEnd(0))
        begins = offset + len(data_end)
        summary, offsets = self._summary(begins)
        told = begins + len(summary)
        head = _FOOTER.pack(Opcode.FOOTER, _FOOTER_LENGTH, begins, told)
        footer = records.Footer(begins, told, zlib.crc32(head, zlib.crc32(summary + offsets)))
        return data_end + summary + offsets + packed(footer) + MAGIC

    def forget(self) -> None:
        """Keep the counts alone."""
        for told in (self._schemas, self._channels, self._chunks, self._attachments, self._metadata):
            told.clear()

    def _summary(self, begins: int) -> tuple[bytes, bytes]:
        """Return the records that tell what is in the file, and those that tell where they are."""
        groups: Iterable[tuple[Opcode, list[bytes]]] = (
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [packed(self._statistics())]),
            (Opcode.CHUNK_INDEX, self._chunks),
            (Opcode.ATTACHMENT_INDEX, self._attachments),
            (Opcode.METADATA_INDEX, self._metadata),
        )
        summary, offsets = bytearray(), bytearray()
        for code, told in groups:
            group = b"".join(told)
            if group:
                offsets += packed(records.SummaryOffset(code, begins + len(summary), len(group)))
            summary += group
        return bytes(summary), bytes(offsets)

    def _statistics(self) -> records.Statistics:
        return records.Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=dict(self.counts),
            chunk_count=len(self._chunks),
            message_count=self.messages,
            message_end_time=self.ends,
            message_start_time=self.begins,
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )
