"""Folders that last as long as their process."""

import os
import time
from pathlib import Path

import pytest

from zteleop.cli._scratch import ALIVE, MADE_WITHIN, scratch


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


def left(place: Path, name: str, *, old: bool = True, alive: bool = True) -> Path:
    """Return a folder whose process was killed."""
    folder = place / name
    folder.mkdir()
    (folder / "chip").write_text("x")
    if alive:
        (folder / ALIVE).write_text("")
    if old:
        then = time.time() - MADE_WITHIN - 5
        os.utime(folder, (then, then))
    return folder


def test_it_is_there_and_then_it_is_not(place: Path) -> None:
    with scratch("demo-") as folder:
        assert folder.parent == place
        (folder / "file").write_text("x")
    assert list(place.iterdir()) == []


def test_what_a_killed_process_left_goes_and_nothing_else_does(place: Path) -> None:
    dead = left(place, "demo-dead")
    kept = {
        left(place, "other-dead"),
        left(place, "demo-young", old=False),
        left(place, "demo-strange", alive=False),
    }
    with scratch("demo-") as folder:
        assert set(place.iterdir()) == kept | {folder}
    assert not dead.exists()


def test_one_that_is_in_use_stays_however_old(place: Path) -> None:
    with scratch("demo-") as first:
        then = time.time() - MADE_WITHIN - 5
        os.utime(first, (then, then))
        with scratch("demo-") as second:
            assert first.exists()
            assert second.exists()
