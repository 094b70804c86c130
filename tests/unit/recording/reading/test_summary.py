from pathlib import Path
from struct import pack

import pytest
from unit.recording.files import CHUNK_INDEX, HEAD, STATISTICS, changed, first, recording

from zteleop.recording.reading import summary
from zteleop.recording.reading.records import BrokenError
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.summary import Summary


def read(folder: Path, data: bytes) -> Summary | None:
    path = folder / "a.mcap"
    path.write_bytes(data)
    source = Source(path)
    try:
        return summary.read(source)
    finally:
        source.close()


def test_the_end_tells_what_is_in_a_file(tmp_path: Path) -> None:
    found = read(tmp_path, recording())
    assert found
    assert (found.statistics.messages, found.statistics.begins, found.statistics.ends) == (12, 1000, 1110)
    assert [(channel.topic, channel.messages) for channel in found.channels.values()] == [
        ("/r/t0", 4),
        ("/r/t1", 4),
        ("/r/t2", 4),
    ]
    assert len(found.chunks) == found.statistics.chunks
    assert [index.name for index in found.attachments] == ["graph.json"]


@pytest.mark.parametrize("option", ["use_statistics", "repeat_channels", "repeat_schemas"])
def test_an_end_that_says_too_little_says_nothing(option: str, tmp_path: Path) -> None:
    assert read(tmp_path, recording(**{option: False})) is None


def test_an_end_need_not_say_anything(tmp_path: Path) -> None:
    data = recording()
    assert read(tmp_path, data[:-28] + bytes(20) + data[-8:]) is None


@pytest.mark.parametrize("cut", [1, 8, 9, 36, 37, 38, 100])
def test_without_its_last_bytes_there_is_no_end(cut: int, tmp_path: Path) -> None:
    with pytest.raises(BrokenError, match=r"it has no end|expected a record of kind 2"):
        read(tmp_path, recording()[:-cut])


@pytest.mark.parametrize(
    ("kind", "at", "lie"),
    [
        (2, 0, pack("<Q", 2**63)),
        (2, 0, pack("<Q", 3)),
        (2, 0, pack("<Q", 60)),
        (STATISTICS, 0, pack("<Q", 1)),
        (STATISTICS, 22, pack("<I", 1)),
        (STATISTICS, 26, pack("<Q", 2**63)),
        (STATISTICS, -8, pack("<Q", 2**63)),
        (CHUNK_INDEX, 16, pack("<Q", 2**63)),
        (CHUNK_INDEX, 0, pack("<Q", 2**63)),
        (10, 0, pack("<Q", 2**63)),
    ],
)
def test_an_end_that_cannot_be_true_is_broken(kind: int, at: int, lie: bytes, tmp_path: Path) -> None:
    data = recording()
    with pytest.raises(BrokenError):
        read(tmp_path, changed(data, first(data, kind).at + HEAD + at, lie))
