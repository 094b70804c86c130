"""Chunks unpacked: as much as can be had of one that is cut off, and never more than fits."""

import io
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from zteleop.errors import ConfigError, install

LARGEST = 2**28
"""bytes of a chunk as it is unpacked; a few bytes that are packed can claim to be any number"""
PIECE = 2**14
"""bytes that are unpacked at once: where a chunk is broken, nothing is left of them"""


def unpack(packing: str, data: bytes, size: int) -> tuple[bytes, str]:
    """Return what a chunk holds, of which `size` bytes are promised, and in words what is wrong with it."""
    if not packing:
        return data, "" if len(data) == size else _differs(len(data), size)
    library = _library(packing)
    found, wrong = bytearray(), ""
    pieces = _zstd_pieces if packing == "zstd" else _lz4_pieces
    try:
        for piece in pieces(library, data):
            found += piece
            if len(found) > LARGEST:
                return bytes(found[:LARGEST]), f"a chunk is more than {LARGEST} bytes unpacked"
    except Exception as error:
        wrong = f"a chunk cannot be unpacked ({packing}: {error})"
    if len(found) == size:  # whatever stands behind it
        return bytes(found), ""
    return bytes(found), wrong or _differs(len(found), size)


def _differs(found: int, promised: int) -> str:
    return f"a chunk holds {found} bytes where {promised} are promised"


def _zstd_pieces(library: Any, data: bytes) -> Iterator[bytes]:
    reader = _zstd_reader(library, data)
    while piece := reader.read(PIECE):
        yield piece


def _lz4_pieces(library: Any, data: bytes) -> Iterator[bytes]:
    decompressor = library.LZ4FrameDecompressor()
    for at in range(0, len(data), PIECE):
        piece = decompressor.decompress(data[at : at + PIECE], max_length=PIECE)
        while piece:
            yield piece
            piece = b"" if decompressor.eof else decompressor.decompress(b"", max_length=PIECE)
        if decompressor.eof:
            return


def _zstd_reader(library: Any, data: bytes) -> Any:
    return library.ZstdDecompressor().stream_reader(io.BytesIO(data))


def _library(packing: str) -> Any:
    try:
        return import_module("zstandard" if packing == "zstd" else "lz4.frame")
    except ModuleNotFoundError as error:
        raise ConfigError(
            f"this recording needs {error.name}, which is not installed; say: {install('record')}"
        ) from None
