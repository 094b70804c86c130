from pathlib import Path

import pytest
from unit.recording.files import NONE, Told, message, ours, recording

from zteleop.recording.reading import order
from zteleop.recording.reading.bag import Bag


def ends_first(number: int, topics: int) -> Told:
    """Return what is told of a message: each third one is as late as can be."""
    topic, at, *rest = message(number, topics)
    return topic, at if number % 3 else 10**6 - at, *rest


def test_chunks_that_overlap_come_in_order(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(recording(60, NONE, told=ends_first))
    assert [one[1] for one in ours(path)] == sorted(ends_first(number, 3)[1] for number in range(60))


def test_chunks_that_overlap_too_much_are_not_held_and_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(order, "MOST", 1000)
    path = tmp_path / "a.mcap"
    path.write_bytes(recording(60, NONE, told=ends_first))
    with Bag(path) as bag:
        found = [kept.at for kept in bag.messages()]
        assert sorted(found) == sorted(ends_first(number, 3)[1] for number in range(60))
        assert "do not come in order" in bag.troubles[0]


def test_chunks_that_follow_one_another_may_be_any_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(order, "MOST", 1000)
    path = tmp_path / "a.mcap"
    path.write_bytes(recording(60, NONE))
    with Bag(path) as bag:
        assert len([*bag.messages()]) == 60
        assert bag.troubles == []
