import os
from pathlib import Path

import pytest

from zteleop.drivers.lock import Lock, machine_folder
from zteleop.errors import DeviceError


@pytest.fixture
def path(tmp_path: Path) -> str:
    return str(tmp_path / "chip.lock")


def test_the_second_is_refused_with_the_process_that_has_it(path: str) -> None:
    held = Lock(path, "the chip")
    words = f"the chip is driven by process {os.getpid()} already; stop it first"
    with pytest.raises(DeviceError, match=rf"^{words} \(Ctrl-C where it runs, or kill {os.getpid()}\)$"):
        Lock(path, "the chip")
    held.release()


def test_a_released_lock_can_be_taken_again(path: str) -> None:
    Lock(path, "the chip").release()
    Lock(path, "the chip").release()


def test_a_refusal_does_not_end_the_owners_lock(path: str) -> None:
    held = Lock(path, "the chip")
    for _ in range(2):
        with pytest.raises(DeviceError):
            Lock(path, "the chip")
    held.release()


def test_releasing_twice_is_harmless(path: str) -> None:
    lock = Lock(path, "the chip")
    lock.release()
    lock.release()


def test_the_pid_of_a_dead_owner_is_replaced(path: str, tmp_path: Path) -> None:
    (tmp_path / "chip.lock").write_text("999999999999\n")
    held = Lock(path, "the chip")
    assert (tmp_path / "chip.lock").read_text() == f"{os.getpid()}\n"
    held.release()


def test_other_users_of_the_machine_may_lock_too(path: str) -> None:
    before = os.umask(0o077)
    try:
        Lock(path, "the chip").release()
    finally:
        os.umask(before)
    assert os.stat(path).st_mode & 0o777 == 0o666


def test_a_symbolic_link_is_not_followed(path: str, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").write_text("keep me")
    os.symlink(tmp_path / "elsewhere", path)
    with pytest.raises(DeviceError, match="cannot open the lock"):
        Lock(path, "the chip")
    assert (tmp_path / "elsewhere").read_text() == "keep me"


def test_a_pipe_in_its_place_is_no_lock_and_keeps_nobody_waiting(tmp_path: Path) -> None:
    path = str(tmp_path / "lock")
    os.mkfifo(path)
    with pytest.raises(DeviceError, match=f"the lock {path} is no file; see what it is, and remove it"):
        Lock(path, "the chip")


def test_locks_of_the_machine_go_where_everybody_may_write() -> None:
    assert os.stat(machine_folder()).st_mode & 0o002
