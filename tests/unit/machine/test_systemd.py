import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from zteleop.machine import systemd

Listen = Callable[[str], socket.socket]


@pytest.fixture
def listen() -> Iterator[Listen]:
    """Stand in for systemd at an address."""
    ears: list[socket.socket] = []

    def bind(address: str) -> socket.socket:
        ears.append(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        ears[-1].bind(address)
        ears[-1].setblocking(False)
        return ears[-1]

    yield bind
    for ear in ears:
        ear.close()


def test_a_state_arrives_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, listen: Listen) -> None:
    init = listen(str(tmp_path / "notify"))
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "notify"))
    systemd.notify("READY=1")
    systemd.notify("WATCHDOG=1")
    assert [init.recv(100), init.recv(100)] == [b"READY=1", b"WATCHDOG=1"]


def test_an_address_without_a_file_is_understood(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, listen: Listen
) -> None:
    init = listen(f"\0{tmp_path}/notify")
    monkeypatch.setenv("NOTIFY_SOCKET", f"@{tmp_path}/notify")
    systemd.notify("READY=1")
    assert init.recv(100) == b"READY=1"


@pytest.mark.parametrize("address", [None, "", "/nowhere/notify", "@nobody", "/" + "x" * 500])
def test_without_somebody_who_listens_nothing_happens(
    address: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("NOTIFY_SOCKET", raising=False)
    if address is not None:
        monkeypatch.setenv("NOTIFY_SOCKET", address)
    systemd.notify("READY=1")


def test_one_who_does_not_read_never_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, listen: Listen
) -> None:
    init = listen(str(tmp_path / "notify"))
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "notify"))
    for _ in range(1000):
        systemd.notify("WATCHDOG=1")
    assert init.recv(100) == b"WATCHDOG=1"
