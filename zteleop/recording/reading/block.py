"""A part of a file that is read at once: a chunk, or records side by side."""

import zlib
from typing import NamedTuple

from zteleop.recording.reading import records
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.records import CHUNK, HEAD, BrokenError, ChunkHead, ChunkIndex
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.unpacking import LARGEST, unpack

HEAD_LENGTH = 64
"""bytes that the head of a chunk has at most"""


class Block(NamedTuple):
    at: int
    """of its records, in the file"""
    length: int
    packing: str
    size: int
    """bytes, unpacked"""
    crc: int
    """0: not said"""
    begins: int
    ends: int
    directory: Directory
    """what is known before it"""
    numbers: bytes = b""
    """which channels are in it, as an index says; empty where none does"""


def of_chunk(at: int, head: ChunkHead, directory: Directory) -> Block:
    """Return the block of the chunk at a place."""
    begins, ends, size, crc, packing, length, starts = head
    return Block(at + HEAD.size + starts, length, packing, size, crc, begins, ends, directory)


def of_index(source: Source, index: ChunkIndex, directory: Directory) -> Block:
    """Return the block of a chunk that an index tells of; raises BrokenError where none is there."""
    kind, length = source.head(index.at)
    if kind != CHUNK:
        raise BrokenError(f"its index tells of a chunk at byte {index.at}, where none is")
    head = records.chunk_head(source.some(index.at + HEAD.size, min(length, HEAD_LENGTH)))
    return of_chunk(index.at, head, directory)._replace(
        begins=index.begins, ends=index.ends, numbers=index.channels
    )


def load(source: Source, block: Block) -> tuple[bytes, str]:
    """Return the records of a block, and what is wrong with them; raises BrokenError where there are none."""
    if block.length > LARGEST:
        raise BrokenError(f"a chunk is {block.length} bytes long; at most {LARGEST} are read")
    data, wrong = unpack(block.packing, source.read(block.at, block.length), block.size)
    if not wrong and block.crc and zlib.crc32(data) != block.crc:
        wrong = "what a chunk holds has changed since it was written, as its checksum tells"
    return data, wrong
