"""MCAP's records, read from bytes that may say anything (mcap.dev/spec)."""

import struct
from itertools import islice
from typing import NamedTuple

MAGIC = b"\x89MCAP0\r\n"
(
    HEADER,
    FOOTER,
    SCHEMA,
    CHANNEL,
    MESSAGE,
    CHUNK,
    MESSAGE_INDEX,
    CHUNK_INDEX,
    ATTACHMENT,
    ATTACHMENT_INDEX,
    STATISTICS,
    METADATA,
    METADATA_INDEX,
    SUMMARY_OFFSET,
    DATA_END,
) = range(1, 16)
HEAD = struct.Struct("<BQ")
"""before each record: what it is, and how long"""
MESSAGE_HEAD = struct.Struct("<HIQQ")
"""of a message: its channel, its sequence, when it arrived and when it was said"""
PRIVATE = 128
"""from here on kinds of records are what their writers say"""
FOOTER_LENGTH = 20
PACKINGS = ("", "zstd", "lz4")
_U16, _U32, _U64 = struct.Struct("<H"), struct.Struct("<I"), struct.Struct("<Q")


class BrokenError(Exception):
    """What a file says of itself is not true."""


class Schema(NamedTuple):
    number: int
    name: str
    encoding: str
    data: bytes


class ChannelRecord(NamedTuple):
    number: int
    schema: int
    """0: none"""
    topic: str
    encoding: str
    metadata: dict[str, str]


class ChunkHead(NamedTuple):
    begins: int
    ends: int
    size: int
    """bytes of the records, unpacked"""
    crc: int
    packing: str
    length: int
    """bytes of the records as they are in the file"""
    at: int
    """where these begin, from the chunk's own beginning on"""


class ChunkIndex(NamedTuple):
    begins: int
    ends: int
    at: int
    """of the chunk, in the file"""
    channels: bytes
    """10 bytes for each channel that has messages in it, the first two its number; empty where not said"""
    packing: str
    length: int
    size: int


class AttachmentHead(NamedTuple):
    at: int
    created: int
    name: str
    media_type: str
    length: int
    starts: int
    """where its data begin, from the record's own beginning on"""


class AttachmentIndex(NamedTuple):
    at: int
    """of the record, in the file"""
    length: int
    logged: int
    size: int
    name: str
    media_type: str


class Statistics(NamedTuple):
    messages: int
    attachments: int
    metadata: int
    chunks: int
    begins: int
    ends: int
    counts: dict[int, int]


class Fields:
    """The fields of a record, one after another; raises BrokenError where one goes past the record's end."""

    def __init__(self, data: bytes, at: int = 0) -> None:
        self._data = data
        self.at = at

    def u16(self) -> int:
        return self._number(_U16)

    def u32(self) -> int:
        return self._number(_U32)

    def u64(self) -> int:
        return self._number(_U64)

    def blob(self) -> bytes:
        length = self.u32()
        self.at += length
        if self.at > len(self._data):
            raise BrokenError(f"a field of {length} bytes goes past the end of its record")
        return self._data[self.at - length : self.at]

    def text(self) -> str:
        return self.blob().decode(errors="replace")

    def pairs(self) -> dict[str, str]:
        inner = Fields(self.blob())
        found = {}
        while not inner.at_end():
            name = inner.text()
            found[name] = inner.text()
        return found

    def at_end(self) -> bool:
        return self.at >= len(self._data)

    def _number(self, kind: struct.Struct) -> int:
        self.at += kind.size
        if self.at > len(self._data):
            raise BrokenError("a record ends within a number")
        return kind.unpack_from(self._data, self.at - kind.size)[0]  # type: ignore[no-any-return]


def header(data: bytes) -> tuple[str, str]:
    """Return the profile, and the library that wrote it."""
    fields = Fields(data)
    return fields.text(), fields.text()


def schema(data: bytes) -> Schema:
    fields = Fields(data)
    return Schema(fields.u16(), fields.text(), fields.text(), fields.blob())


def channel(data: bytes) -> ChannelRecord:
    fields = Fields(data)
    return ChannelRecord(fields.u16(), fields.u16(), fields.text(), fields.text(), fields.pairs())


def chunk_head(data: bytes) -> ChunkHead:
    fields = Fields(data)
    begins, ends, size, crc = fields.u64(), fields.u64(), fields.u64(), fields.u32()
    packing, length = fields.text(), fields.u64()
    if packing not in PACKINGS:
        raise BrokenError(f"a chunk is packed as {packing!r:.40}; expected zstd, lz4 or nothing")
    return ChunkHead(begins, ends, size, crc, packing, length, fields.at)


def chunk_index(data: bytes) -> ChunkIndex:
    fields = Fields(data)
    begins, ends, at, _ = fields.u64(), fields.u64(), fields.u64(), fields.u64()
    channels, _ = fields.blob(), fields.u64()
    return ChunkIndex(begins, ends, at, channels, fields.text(), fields.u64(), fields.u64())


def attachment_head(data: bytes) -> AttachmentHead:
    fields = Fields(data)
    at, created, name, media_type = fields.u64(), fields.u64(), fields.text(), fields.text()
    return AttachmentHead(at, created, name, media_type, fields.u64(), fields.at)


def attachment_index(data: bytes) -> AttachmentIndex:
    fields = Fields(data)
    at, length, logged, _ = fields.u64(), fields.u64(), fields.u64(), fields.u64()
    return AttachmentIndex(at, length, logged, fields.u64(), fields.text(), fields.text())


def metadata(data: bytes) -> tuple[str, dict[str, str]]:
    fields = Fields(data)
    return fields.text(), fields.pairs()


def metadata_index(data: bytes) -> tuple[int, int]:
    """Return where a record of metadata is, and how long."""
    fields = Fields(data)
    return fields.u64(), fields.u64()


def statistics(data: bytes) -> Statistics:
    fields = Fields(data)
    messages, _, _ = fields.u64(), fields.u16(), fields.u32()
    attachments, noted, chunks = fields.u32(), fields.u32(), fields.u32()
    begins, ends, counts = fields.u64(), fields.u64(), fields.blob()
    pairs = struct.iter_unpack("<HQ", counts[: len(counts) // 10 * 10])
    return Statistics(messages, attachments, noted, chunks, begins, ends, dict(islice(pairs, 2**16)))


def footer(data: bytes) -> int:
    """Return where the summary begins; 0 where there is none."""
    return Fields(data).u64()
