import random
from pathlib import Path

import pytest
from unit.recording.files import recording, records

from zteleop.recording.reading import landmark
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.landmark import Landmarks
from zteleop.recording.reading.records import CHANNEL, HEAD, SCHEMA
from zteleop.recording.reading.source import Source
from zteleop.recording.reading.walk import walk

KINDS = {1, 2, 3, 4, 5, 6, 7, 9, 12, 15}
"""of records that are recognized wherever they are"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.mcap"


@pytest.mark.parametrize("options", [{}, {"use_chunking": False}])
@pytest.mark.parametrize("window", [64, 2**20])
def test_from_anywhere_the_next_record_is_found(
    options: dict[str, bool], window: int, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(landmark, "WINDOW", window)
    data = recording(**options)
    path.write_bytes(data)
    source = Source(path)
    known = Directory()
    for kind, at, end in records(data):
        if kind in (SCHEMA, CHANNEL):
            body = data[at + HEAD.size : end]
            known = known.with_schema(body) if kind == SCHEMA else known.with_channel(body)
    places = [record.at for record in records(data) if record.kind in KINDS]
    for start in range(9, len(data) - 40, 7):
        wanted = next(place for place in [*places, len(data) - 8] if place >= start)
        assert Landmarks(source).next(start, known) == wanted
    source.close()


def test_in_noise_nothing_is_found(path: Path) -> None:
    path.write_bytes(random.Random(1).randbytes(300_000) + bytes(100_000) + bytes([5]) * 1000)
    source = Source(path)
    assert Landmarks(source).next(0, Directory()) is None
    assert walk(source).gaps[0].length == source.size
    source.close()
