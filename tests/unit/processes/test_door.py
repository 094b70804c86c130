"""The program of a door, whose zenoh is a stand-in."""

import io
import os
import signal
import socket
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest

from zteleop.bus.settings import BusSettings
from zteleop.errors import ConfigError, DeviceError
from zteleop.machine.door import ALIVE
from zteleop.processes import PROGRAMS, door
from zteleop.processes.door import Orders

ORDERS = Orders(BusSettings(listen=["tcp/[::]:1"]), settle=True)


class Session:
    """A session of zenoh that counts its proofs, and fails them when told to."""

    def __init__(self) -> None:
        self.proofs, self.closed = 0, False
        self.broken: BaseException | None = None

    def prove(self) -> None:
        self.proofs += 1
        if self.broken:
            raise self.broken

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *exc: object) -> None:
        self.closed = True


class Panic(BaseException):
    """As that of pyo3."""


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[dict[str, Any]]:
    """A watchdog's end of the link, and what the door was made of."""
    session = Session()
    ours, theirs = socket.socketpair()
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(str(tmp_path / "door"))
    listener.listen()
    made: dict[str, Any] = {"session": session, "ours": ours, "ignored": set(), "order": []}

    def open_zenoh(bus: BusSettings, *, settle: bool, door: bool) -> str:
        made.update(bus=bus, settle=settle, door=door)
        made["order"].append("zenoh's threads start")
        return "zenoh"

    def ask_for(priority: int, score: int) -> list[str]:
        made["order"].append(f"takes {priority}")
        return []

    monkeypatch.setattr(door, "open_zenoh", open_zenoh)
    monkeypatch.setattr(door, "ZenohSession", lambda zenoh: session)
    monkeypatch.setattr(door.realtime, "ask_for", ask_for)
    monkeypatch.setattr(signal, "signal", lambda number, handler: made["ignored"].add(number))
    monkeypatch.setattr(door.sys, "stdin", SimpleNamespace(buffer=io.BytesIO(msgspec.json.encode(ORDERS))))
    made["files"] = listener.detach(), theirs.detach()
    with ours:
        yield made


def test_it_joins_as_told_and_says_that_it_lives_until_its_watchdog_leaves(made: dict[str, Any]) -> None:
    made["ours"].shutdown(socket.SHUT_WR)
    assert door.run(*made["files"]) == 0
    assert (made["bus"], made["settle"], made["door"]) == (ORDERS.bus, True, True)
    assert made["session"].closed
    assert signal.SIGTERM in made["ignored"], "it goes last"
    assert made["order"] == ["zenoh's threads start", f"takes {door.PROGRAM.priority}"]


def test_it_says_that_it_lives_and_proves_that_zenoh_does(made: dict[str, Any]) -> None:
    session, prove = made["session"], made["session"].prove

    def prove_and_leave() -> None:
        prove()
        made["heard"] = made["ours"].recv(10)
        made["ours"].shutdown(socket.SHUT_WR)

    session.prove = prove_and_leave
    assert door.run(*made["files"]) == 0
    assert (made["heard"], session.proofs) == (ALIVE, 1)


def test_a_panic_of_zenohs_ends_it_at_once(
    made: dict[str, Any], monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def leave(code: int) -> None:
        raise SystemExit(code)

    monkeypatch.setattr(os, "_exit", leave)
    made["session"].broken = Panic("PoisonError { .. }")
    with pytest.raises(SystemExit, match=str(door.BROKEN)):
        door.run(*made["files"])
    assert "door: error: zenoh broke (PoisonError { .. }); this door ends" in capfd.readouterr().err


def test_it_goes_before_those_it_serves_and_behind_whoever_steps_the_chip() -> None:
    assert PROGRAMS["actuator"].priority > door.PROGRAM.priority > door.realtime.FEEDERS
    assert PROGRAMS["actuator"].oom_score < door.PROGRAM.oom_score < PROGRAMS["blackbox"].oom_score


@pytest.mark.parametrize("text", [b"", b"{", b"null", b'{"bus":{"mode":"x"}}', b"\xff", b'{"bus":' * 5000])
def test_orders_that_are_none_are_refused_in_words(text: bytes) -> None:
    with pytest.raises(ConfigError, match=r"^expected a watchdog's orders on standard input: "):
        door._orders(text)


@pytest.mark.parametrize("number", [-1, 10**20, 987654])
def test_a_file_that_is_no_watchdogs_is_refused_in_words(number: int) -> None:
    with pytest.raises(DeviceError, match="zteleop actuator starts its door"):
        door._adopt(number)
