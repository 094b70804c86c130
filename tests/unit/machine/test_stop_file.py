import errno
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.machine import stop_file as module
from zteleop.machine.stop_file import UNREADABLE, StopFile
from zteleop.messages import Stop

STOP = Stop(engaged=True, id=2**53 - 3, by="ann", why="a child on the track")
BOBS = Stop(engaged=True, id=3, by="bob", why="")
CARLS = Stop(engaged=True, id=4, by="carl", why="")


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
    assert (file.exists(), file.load(), file.ids()) == (False, [], frozenset())


def test_a_stop_is_kept_for_every_later_process(file: StopFile) -> None:
    file.keep([STOP])
    assert file.exists()
    assert StopFile(file.path, print).load() == [STOP]


def test_every_stop_is_kept_and_one_more_beside_what_another_process_kept(file: StopFile) -> None:
    file.keep([STOP, BOBS])
    another = StopFile(file.path, print)
    another.add(CARLS)
    assert file.load() == [STOP, BOBS, CARLS]
    newer = Stop(engaged=True, id=8, by="bob", why="")
    another.add(newer)
    assert file.load() == [STOP, CARLS, newer]


def test_a_crowd_of_stops_with_long_reasons_is_read_as_it_was_kept(file: StopFile) -> None:
    crowd = [Stop(engaged=True, id=number, by="\u00e4" * 200, why="\u6f22" * 200) for number in range(65)]
    file.keep(crowd)
    assert file.load() == crowd


def test_a_look_costs_a_read_only_when_something_changed(
    file: StopFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    file.keep([STOP])
    assert file.ids() == {STOP.id}
    with monkeypatch.context() as patch:
        patch.setattr(module, "_read", refusing(errno.EIO))
        assert file.ids() == {STOP.id}
    file.keep([STOP, BOBS])
    assert file.ids() == {STOP.id, BOBS.id}
    file.release(STOP, [BOBS])
    assert file.ids() == {BOBS.id}
    file.release(BOBS, [])
    assert file.ids() == frozenset()


def test_what_cannot_be_kept_is_said_once_and_tried_again(
    file: StopFile, warnings: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file.promise([STOP])
    assert (file.unkept, file.exists()) == ("they are being written", False)
    with monkeypatch.context() as patch:
        patch.setattr(module, "_write", refusing(errno.EROFS))
        for _ in range(3):
            file.tend()
    assert file.unkept == f"{file.path}: {os.strerror(errno.EROFS)}"
    assert len(warnings) == 1
    file.tend()
    assert (file.unkept, file.load()) == ("", [STOP])
    file.path.unlink()
    file.tend()
    assert not file.exists(), "what was kept is not kept again when somebody takes it away"


def test_a_stop_released_is_gone_and_may_be_released_twice(file: StopFile, warnings: list[str]) -> None:
    file.keep([STOP])
    assert file.release(STOP, [])
    assert file.load() == []
    assert file.release(STOP, [])
    assert warnings == []


def test_the_disk_is_waited_for_elsewhere(
    file: StopFile, threads: list[Thread], monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[str] = []
    monkeypatch.setattr(
        module.os, "fsync", lambda number: synced.append(os.readlink(f"/proc/self/fd/{number}"))
    )
    file.keep([STOP])
    file.release(STOP, [])
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
    file.keep([STOP])
    threads[0].run()
    assert file.load() == [STOP]


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
    (stop,) = file.load()
    assert file.exists()
    assert file.ids() == {stop.id} == {UNREADABLE}
    assert (stop.engaged, stop.by) == (True, "nobody known")
    assert stop.why.endswith("stop is there and cannot be read")
    assert 0 <= stop.id < 2**53


def test_a_released_stop_in_the_file_still_means_stopped(file: StopFile) -> None:
    file.keep([Stop(engaged=False, id=4, by="bob", why="")])
    assert file.load() == [Stop(engaged=True, id=4, by="bob", why="")]


def test_a_folder_in_its_place_means_stopped_and_stays(file: StopFile, warnings: list[str]) -> None:
    file.path.mkdir(parents=True)
    assert file.exists()
    assert file.load()[0].by == "nobody known"
    file.keep([STOP])
    assert "the stop holds, but not across a restart" in warnings[0]
    assert not file.release(STOP, [])
    assert "the stop cannot be released" in warnings[1]
    assert "remove it by hand" in warnings[1]
    assert file.exists()


def test_a_link_to_itself_means_stopped(file: StopFile) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.symlink_to(file.path)
    assert file.exists()
    assert file.load()[0].by == "nobody known"


@pytest.mark.parametrize("number", [errno.EACCES, errno.EIO, errno.ELOOP, errno.ENAMETOOLONG])
def test_a_file_that_cannot_be_looked_at_means_stopped(
    file: StopFile, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module.os, "stat", refusing(number))
    monkeypatch.setattr(module, "_read", refusing(number))
    assert file.exists()
    assert file.load()[0].engaged


@pytest.mark.parametrize("number", [errno.EACCES, errno.EIO, errno.ENOENT])
def test_a_file_that_cannot_be_read_means_stopped(
    file: StopFile, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    file.keep([STOP])
    monkeypatch.setattr(module, "_read", refusing(number))
    assert file.load()[0].by == "nobody known"


@pytest.mark.parametrize("number", [errno.EROFS, errno.EACCES, errno.ENOSPC])
def test_what_cannot_be_kept_is_said_and_raises_nothing(
    file: StopFile,
    number: int,
    warnings: list[str],
    threads: list[Thread],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_write", refusing(number))
    file.keep([STOP])
    assert warnings == [f"the stop holds, but not across a restart: {file.path}: {os.strerror(number)}"]
    assert threads == []


def test_a_full_disk_leaves_a_file_that_means_stopped(
    file: StopFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    def open_only(path: Path, data: bytes) -> None:
        path.open("wb").close()
        refusing(errno.ENOSPC)()

    monkeypatch.setattr(module, "_write", open_only)
    file.keep([STOP])
    assert file.load()[0].engaged


@pytest.mark.parametrize("number", [errno.EROFS, errno.EACCES])
def test_a_file_that_cannot_be_removed_keeps_the_robot_stopped(
    file: StopFile, number: int, warnings: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file.keep([STOP])
    monkeypatch.setattr(Path, "unlink", refusing(number))
    assert not file.release(STOP, [])
    assert warnings == [f"the stop cannot be released: {file.path}: {os.strerror(number)}; remove it by hand"]
    assert file.load() == [STOP]


def test_a_pipe_in_the_files_place_means_stopped_and_is_not_waited_for(
    file: StopFile, warnings: list[str]
) -> None:
    file.path.parent.mkdir(parents=True)
    os.mkfifo(file.path)
    assert file.load()[0].by == "nobody known"
    file.keep([STOP])
    assert "the stop holds, but not across a restart" in warnings[0]


def test_the_last_stop_released_is_known_to_every_later_process(file: StopFile) -> None:
    assert file.released() == 0
    file.keep([STOP])
    assert file.released() == 0
    file.release(STOP, [])
    assert StopFile(file.path, print).released() == STOP.id
    assert file.release(STOP, [])
    assert file.released() == STOP.id


@pytest.mark.parametrize("content", [b"", b"\xff", b'{"engaged": true}', b"null"])
def test_a_stop_that_cannot_be_read_can_be_released(file: StopFile, content: bytes) -> None:
    file.path.parent.mkdir(parents=True)
    file.path.write_bytes(content)
    (stop,) = file.load()
    assert file.release(stop, [])
    assert file.released() == UNREADABLE


@pytest.mark.parametrize("content", [b"", b"\xff", b'{"engaged": true}', b"null"])
def test_a_past_that_cannot_be_read_was_one(file: StopFile, content: bytes) -> None:
    file.keep([STOP])
    file.path.with_name("stop.released").write_bytes(content)
    assert file.released() == 1


def test_where_the_past_cannot_be_kept_a_stop_is_released_all_the_same(
    file: StopFile, monkeypatch: pytest.MonkeyPatch, warnings: list[str]
) -> None:
    file.keep([STOP])
    monkeypatch.setattr(module, "_write", refusing(errno.ENOSPC))
    assert file.release(STOP, [])
    assert (file.exists(), file.released(), warnings) == (False, 0, [])
