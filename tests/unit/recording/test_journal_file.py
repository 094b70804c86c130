import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.messages import Time, Twist
from zteleop.recording import journal_file
from zteleop.recording.journal_file import Entry, JournalFile


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "state" / "journal.jsonl"


class Watched(JournalFile):
    """Tells when its thread begins and ends to write."""

    def __init__(self, path: Path) -> None:
        self.begun, self.done = threading.Event(), threading.Event()
        super().__init__(path)

    def _write(self) -> None:
        super()._write()
        self.done.set()

    def _append(self, data: bytes) -> None:
        self.begun.set()
        super()._append(data)


def line(event: str = "act", **values: Any) -> Entry:
    return Entry(Time(1_700_000_000, 123_456_789), 41.9876, event, values)


def kept(path: Path) -> list[dict[str, Any]]:
    return [json.loads(text) for text in path.read_text().splitlines() if text]


def test_a_line_says_when_by_both_clocks_and_what(path: Path) -> None:
    file = JournalFile(path)
    file.put(line(source="keyboard", command=Twist.planar(0.5)))
    file.close()
    (told,) = kept(path)
    assert told.pop("command")["linear"] == {"x": 0.5, "y": 0.0, "z": 0.0}
    assert told == {"time": "2023-11-14T22:13:20.123Z", "at": 41.988, "event": "act", "source": "keyboard"}
    assert not file.trouble


def test_what_json_or_a_terminal_cannot_take_is_made_harmless() -> None:
    told = line(why="\x1b[2J\x9b\ud800", what={1, 2}, long="x" * 9000).encode()
    assert told.isascii()
    assert json.loads(told)["why"] == "\\u001b[2J\\u009b\\ud800"
    assert json.loads(told)["what"]
    assert len(told) < 1000


def test_two_files_are_kept_and_none_is_larger_than_its_size(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal_file, "SIZE", 1000)
    for number in range(40):
        file = JournalFile(path)
        file.put(line(number=number))
        file.close()
    assert sorted(os.listdir(path.parent)) == ["journal.jsonl", "journal.old"]
    assert all(other.stat().st_size <= 1000 for other in path.parent.iterdir())
    told = [entry["number"] for entry in kept(path.with_suffix(".old")) + kept(path)]
    assert told == list(range(told[0], 40))
    assert len(told) > 8


def test_half_a_line_that_a_pulled_battery_left_spoils_no_other(path: Path) -> None:
    path.parent.mkdir()
    path.write_bytes(b'{"time":"20')
    file = JournalFile(path)
    file.put(line())
    file.close()
    half, whole = path.read_text().splitlines()
    assert half == '{"time":"20'
    assert json.loads(whole)["event"] == "act"


def test_what_was_written_is_on_the_disk_before_the_end(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sizes = []
    monkeypatch.setattr(os, "fsync", lambda file: sizes.append(os.fstat(file).st_size))
    file = JournalFile(path)
    file.put(line())
    file.close()
    assert sizes == [path.stat().st_size]


def test_a_line_is_on_the_disk_a_second_later_without_an_end(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced = threading.Event()
    monkeypatch.setattr(os, "fsync", lambda _: synced.set())
    monkeypatch.setattr(journal_file, "SYNC", 0.05)
    monkeypatch.setattr(journal_file, "GATHER", 0.0)
    file = JournalFile(path)
    file.put(line())
    assert synced.wait(10)
    file.close()


def test_a_folder_that_cannot_be_is_trouble_at_once(tmp_path: Path) -> None:
    (tmp_path / "state").write_text("a file")
    file = JournalFile(tmp_path / "state" / "journal.jsonl")
    assert "journal.jsonl: " in file.trouble
    file.put(line())
    file.close()


def test_a_full_disk_loses_lines_counts_them_and_is_tried_again(path: Path) -> None:
    path.parent.mkdir()
    path.symlink_to("/dev/full")
    file = Watched(path)
    file.put(line("lost to it"))
    assert file.done.wait(10)
    assert "No space left" in file.trouble

    path.unlink()
    for event in ("after", "later"):
        file.done.clear()
        file.put(line(event))
        assert file.done.wait(10)
    file.close()
    told = [(entry["event"], entry.get("count")) for entry in kept(path)]
    assert told == [("after", None), ("lost", 1), ("later", None)]


def test_half_a_write_is_a_full_disk(path: Path) -> None:
    file = Watched(path)
    file._shut()
    file._file = SimpleNamespace(write=lambda data: len(data) // 2, close=lambda: None)  # type: ignore[assignment]
    file.put(line())
    assert file.done.wait(10)
    file.close()
    assert "No space left" in file.trouble


@pytest.fixture
def hung(path: Path) -> Iterator[int]:
    """A disk that takes 64 KiB and then hangs until it is read."""
    path.parent.mkdir()
    os.mkfifo(path)
    reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    yield reader
    os.close(reader)


def test_a_disk_that_hangs_delays_neither_a_line_nor_the_end(
    path: Path, hung: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal_file, "FLUSH", 0.01)
    monkeypatch.setattr(journal_file, "GATHER", 0.0)
    monkeypatch.setattr(os, "fsync", lambda _: None)
    file = Watched(path)
    file.put(line(filler=["x" * 400] * 500))
    assert file.begun.wait(10)
    for number in range(journal_file.WAITING + 50):
        file.put(line(number=number))
    file.close()
    assert file._thread.is_alive()

    told = read_all(hung, file._thread)
    assert [entry["count"] for entry in told if entry["event"] == "lost"] == [50]
    assert [entry["number"] for entry in told if "number" in entry] == list(range(journal_file.WAITING))


def read_all(reader: int, writer: threading.Thread) -> list[dict[str, Any]]:
    """Read what a thread writes until it has ended."""
    os.set_blocking(reader, True)
    data = b""
    while chunk := os.read(reader, 1 << 16):
        data += chunk
    writer.join(10)
    return [json.loads(text) for text in data.splitlines() if text]


def test_a_pipe_that_nobody_reads_is_not_waited_for(path: Path) -> None:
    path.parent.mkdir()
    os.mkfifo(path)
    file = JournalFile(path)
    file.put(line())
    file.close()
    assert str(path) in file.trouble
