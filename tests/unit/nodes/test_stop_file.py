import errno
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.messages import Stop
from zteleop.nodes import stop_file as module
from zteleop.nodes.stop_file import StopFile

STOP = Stop(engaged=True, id=2**53 - 1, by="ann", why="a child on the track")


class Thread:
    """A thread that runs when the test says so."""

    waiting: list["Thread"] = []

    def __init__(self, target: Any, args: Any, daemon: bool) -> None:
        self.run, self.daemon = lambda: target(*args), daemon

    def start(self) -> None:
        self.waiting.append(self)


@pytest.fixture(autouse=True)
def threads(monkeypatch: pytest.MonkeyPatch) -> list[Thread]:
    monkeypatch.setattr(module, "threading", SimpleNamespace(Thread=Thread))
    monkeypatch.setattr(Thread, "waiting", [])
    return Thread.waiting


@pytest.fixture
def warnings() -> list[str]:
    return []


@pytest.fixture
def file(tmp_path: Path, warnings: list[str]) -> StopFile:
    return StopFile(tmp_path / "robots" / "archangel" / "stop", warnings.append)


def refusing(number: int) -> Any:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    return refuse


def test_without_a_file_the_robot_is_not_stopped(file: StopFile) -> None:
    assert (file.exists(), file.load()) == (False, None)


def test_a_stop_is_kept_for_every_later_process(file: StopFile) -> None:
    file.keep(STOP)
    assert file.exists()
    assert StopFile(file.path, print).load() == STOP


def test_the_newest_stop_is_the_one_kept(file: StopFile) -> None:
    file.keep(STOP)
    file.keep(Stop(engaged=True, id=3, by="bob", why=""))
    assert file.load().id == 3


def test_a_stop_removed_is_gone_and_may_be_removed_twice(file: StopFile, warnings: list[str]) -> None:
    file.keep(STOP)
    assert file.remove()
    assert file.load() is None
    assert file.remove()
    assert warnings == []


def test_the_disk_is_waited_for_elsewhere(
    file: StopFile, threads: list[Thread], monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[str] = []
    monkeypatch.setattr(
        module.os, "fsync", lambda number: synced.append(os.readlink(f"/proc/self/fd/{number}"))
    )
    file.keep(STOP)
    file.remove()
    assert synced == []
    assert all(thread.daemon for thread in threads)
    threads[1].run()
    assert synced == [str(file.path.parent)]
    threads[0].run()  # its file is gone by now
    assert len(synced) == 1


def test_a_disk_that_does_not_sync_says_nothing(
    file: StopFile, threads: list[Thread], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module.os, "fsync", refusing(errno.EIO))
    file.keep(STOP)
    threads[0].run()
    assert file.load() == STOP


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x00" * 100,
        b"\xff\xfe garbage",
        b'{"engaged": true',
        b"[]",
        b"null",
        b'{"engaged": true, "id": -1, "by": "", "why": ""}',
        b'{"engaged": true}',
        b'"' + b"x" * 10000,
    ],
)
def test_whatever_stands_in_the_file_means_stopped(file: StopFile, content: bytes) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.write_bytes(content)
    stop = file.load()
    assert file.exists()
    assert stop
    assert (stop.engaged, stop.by) == (True, "nobody known")
    assert stop.why.endswith("stop is there and cannot be read")
    assert 0 <= stop.id < 2**53


def test_a_released_stop_in_the_file_still_means_stopped(file: StopFile) -> None:
    file.keep(Stop(engaged=False, id=4, by="bob", why=""))
    assert file.load() == Stop(engaged=True, id=4, by="bob", why="")


def test_a_folder_in_its_place_means_stopped_and_stays(file: StopFile, warnings: list[str]) -> None:
    file.path.mkdir(parents=True)
    assert file.exists()
    assert file.load().by == "nobody known"
    file.keep(STOP)
    assert "the stop holds, but not across a restart" in warnings[0]
    assert not file.remove()
    assert "the stop cannot be released" in warnings[1]
    assert "remove it by hand" in warnings[1]
    assert file.exists()


def test_a_link_to_itself_means_stopped(file: StopFile) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.symlink_to(file.path)
    assert file.exists()
    assert file.load().by == "nobody known"


@pytest.mark.parametrize("number", [errno.EACCES, errno.EIO, errno.ELOOP, errno.ENAMETOOLONG])
def test_a_file_that_cannot_be_looked_at_means_stopped(
    file: StopFile, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module.os, "stat", refusing(number))
    monkeypatch.setattr(module, "_read", refusing(number))
    assert file.exists()
    assert file.load().engaged


@pytest.mark.parametrize("number", [errno.EACCES, errno.EIO, errno.ENOENT])
def test_a_file_that_cannot_be_read_means_stopped(
    file: StopFile, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    file.keep(STOP)
    monkeypatch.setattr(module, "_read", refusing(number))
    assert file.load().by == "nobody known"


@pytest.mark.parametrize("number", [errno.EROFS, errno.EACCES, errno.ENOSPC])
def test_what_cannot_be_kept_is_said_and_raises_nothing(
    file: StopFile,
    number: int,
    warnings: list[str],
    threads: list[Thread],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_write", refusing(number))
    file.keep(STOP)
    assert warnings == [f"the stop holds, but not across a restart: {file.path}: {os.strerror(number)}"]
    assert threads == []


def test_a_full_disk_leaves_a_file_that_means_stopped(
    file: StopFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    def open_only(path: Path, data: bytes) -> None:
        path.open("wb").close()
        refusing(errno.ENOSPC)()

    monkeypatch.setattr(module, "_write", open_only)
    file.keep(STOP)
    assert file.load().engaged


@pytest.mark.parametrize("number", [errno.EROFS, errno.EACCES])
def test_a_file_that_cannot_be_removed_keeps_the_robot_stopped(
    file: StopFile, number: int, warnings: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file.keep(STOP)
    monkeypatch.setattr(Path, "unlink", refusing(number))
    assert not file.remove()
    assert warnings == [f"the stop cannot be released: {file.path}: {os.strerror(number)}; remove it by hand"]
    assert file.load() == STOP


def test_a_pipe_in_the_files_place_means_stopped_and_is_not_waited_for(
    file: StopFile, warnings: list[str]
) -> None:
    file.path.parent.mkdir(parents=True)
    os.mkfifo(file.path)
    assert file.load().by == "nobody known"
    file.keep(STOP)
    assert "the stop holds, but not across a restart" in warnings[0]


def test_the_last_stop_released_is_known_to_every_later_process(file: StopFile) -> None:
    assert file.released() == 0
    file.keep(STOP)
    assert file.released() == 0
    file.remove()
    assert StopFile(file.path, print).released() == STOP.id
    assert file.remove()
    assert file.released() == STOP.id


@pytest.mark.parametrize("content", [b"", b"\xff", b'{"engaged": true}', b"null"])
def test_a_released_stop_that_cannot_be_read_was_one(file: StopFile, content: bytes) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.write_bytes(content)
    assert file.remove()
    assert file.released() == 1


def test_where_the_past_cannot_be_kept_a_stop_is_released_all_the_same(
    file: StopFile, monkeypatch: pytest.MonkeyPatch, warnings: list[str]
) -> None:
    file.keep(STOP)
    monkeypatch.setattr(module, "_write", refusing(errno.ENOSPC))
    assert file.remove()
    assert (file.exists(), file.released(), warnings) == (False, 0, [])
