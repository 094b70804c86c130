"""A file that is changed while a program goes by what it read there."""

import os
from pathlib import Path

import pytest

from zteleop.machine.changes import Changes


class Watched:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.told: list[str] = []
        self.write("a = 1\n")
        self.changes = Changes(path)

    def look(self) -> None:
        self.changes.look(self.told.append)

    def write(self, text: str) -> None:
        """Write it as editors do: another file takes the name."""
        beside = self.path.with_suffix(".new")
        beside.write_text(text)
        os.replace(beside, self.path)


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Watched:
    monkeypatch.chdir(tmp_path)
    return Watched(Path("config.toml"))


def test_other_content_is_told_once(file: Watched) -> None:
    file.write("a = 2\n")
    for _ in range(3):
        file.look()
    assert file.told == ["config.toml has changed; what it says counts once this is started again"]


def test_every_other_change_is_told(file: Watched) -> None:
    for text in ("a = 2\n", "a = 3\n"):
        file.write(text)
        file.look()
    assert len(file.told) == 2


def test_what_was_only_touched_or_saved_again_is_not(file: Watched) -> None:
    os.utime(file.path, (1, 1))
    file.look()
    file.write("a = 1\n")
    file.look()
    assert file.told == []


def test_what_is_as_it_was_at_the_start_is_in_force(file: Watched) -> None:
    for text in ("a = 2\n", "a = 1\n"):
        file.write(text)
        file.look()
    assert len(file.told) == 1


def test_a_file_that_is_away_for_a_moment_has_not_changed(file: Watched) -> None:
    file.path.unlink()
    file.look()
    file.write("a = 1\n")
    file.look()
    assert file.told == []
    file.write("a = 2\n")
    file.look()
    assert len(file.told) == 1


def test_it_is_the_file_that_was_read_wherever_the_program_goes(
    file: Watched, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    (tmp_path / "config.toml").write_text("a = 22\n")
    file.look()
    assert len(file.told) == 1
