import random
import tracemalloc
from collections.abc import Callable

import lz4.frame
import pytest
import zstandard

from zteleop.errors import ConfigError
from zteleop.recording.reading import unpacking
from zteleop.recording.reading.unpacking import LARGEST, unpack

DICE = random.Random(0)
DATA = b"".join(DICE.choice((b"hello world", bytes(9), bytes([n % 256]) * 5)) for n in range(60_000))
PACK: dict[str, Callable[[bytes], bytes]] = {"zstd": zstandard.compress, "lz4": lz4.frame.compress}


@pytest.mark.parametrize("packing", PACK)
def test_what_is_whole_is_unpacked(packing: str) -> None:
    assert unpack(packing, PACK[packing](DATA), len(DATA)) == (DATA, "")
    assert unpack(packing, PACK[packing](b""), 0) == (b"", "")
    assert unpack("", DATA, len(DATA)) == (DATA, "")


@pytest.mark.parametrize("packing", PACK)
@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.5, 0.9, 0.999])
def test_of_what_is_cut_off_as_much_as_there_is(packing: str, share: float) -> None:
    packed = PACK[packing](DATA)
    found, wrong = unpack(packing, packed[: int(len(packed) * share)], len(DATA))
    assert DATA.startswith(found)
    assert len(found) > (share - 0.25) * len(DATA)
    assert wrong


@pytest.mark.parametrize("packing", PACK)
def test_what_stands_behind_is_left_alone(packing: str) -> None:
    assert unpack(packing, PACK[packing](DATA) + b"garbage" * 100, len(DATA)) == (DATA, "")


@pytest.mark.parametrize("packing", PACK)
@pytest.mark.parametrize("size", [0, 1, len(DATA) - 1, len(DATA) + 1, 2**63])
def test_a_size_that_lies_is_told(packing: str, size: int) -> None:
    found, wrong = unpack(packing, PACK[packing](DATA), size)
    assert found == DATA
    assert wrong == f"a chunk holds {len(DATA)} bytes where {size} are promised"
    assert unpack("", DATA, size)[1] == wrong


@pytest.mark.parametrize("packing", PACK)
def test_garbage_is_nothing(packing: str) -> None:
    found, wrong = unpack(packing, b"garbage" * 100, 700)
    assert found == b""
    assert packing in wrong


def bombs() -> list[tuple[str, bytes]]:
    """Return a few kB that unpack to 64 MB, with and without saying so."""
    frames = [
        zstandard.ZstdCompressor(write_content_size=told).compressobj(2**26 if told else -1)
        for told in (1, 0)
    ]
    piece = bytes(2**24)
    packed = [("zstd", b"".join([*(one.compress(piece) for _ in range(4)), one.flush()])) for one in frames]
    for one in (lz4.frame.LZ4FrameCompressor(block_linked=True), lz4.frame.LZ4FrameCompressor()):
        data = one.begin(2**26) + b"".join(one.compress(piece) for _ in range(4)) + one.flush()
        packed.append(("lz4", data))
    return packed


def test_a_bomb_takes_no_more_memory_than_the_largest_chunk_that_is_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(unpacking, "LARGEST", 2**20)
    for packing, bomb in bombs():
        for size in (100, 2**30, 2**63):
            tracemalloc.start()
            try:
                found, wrong = unpack(packing, bomb, size)
                _, most = tracemalloc.get_traced_memory()
            finally:
                tracemalloc.stop()
            assert len(found) == 2**20
            assert "more than 1048576 bytes" in wrong
            assert most < 2**23


def test_a_frame_that_declares_all_the_memory_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    frame = b"\x28\xb5\x2f\xfd" + bytes([0b11000000, 0xF8]) + b"\xff" * 8 + b"\x01\0\0"
    assert unpack("zstd", frame, LARGEST)[0] == b""


def test_without_the_library_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "zstandard", None)
    with pytest.raises(ConfigError, match=r"needs zstandard, .* pip install .*\[record\]'"):
        unpack("zstd", b"", 0)
