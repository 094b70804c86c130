import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest

from zteleop.bus.settings import BusSettings
from zteleop.config import Config
from zteleop.machine import signals
from zteleop.processes import blackbox
from zteleop.recording.ring import TOPICS_AT_MOST
from zteleop.testing import FakeNode

SETTINGS = Config(robot="archangel", bus=BusSettings(mode="client", connect=["door//tmp/x/door"]))


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """What the black box was made of."""
    made: dict[str, Any] = {"handled": {}}

    @contextmanager
    def join(name: str, robot: str, session: str) -> Iterator[Any]:
        assert (session, made["tapped"]) == ("session", True), "who sees it there counts on being heard"
        made["held"] = signal.pthread_sigmask(signal.SIG_BLOCK, [])
        made.update(name=name, node=FakeNode(name, robot))
        yield made["node"]
        made["left"] = True

    def open_bus(bus: BusSettings) -> str:
        made["bus"] = bus
        return "session"

    def listen(session: str, robot: str, known: Any) -> Any:
        made["tapped"] = True
        return session, robot, known

    def box(node: Any, tap: Any, ring: Any, writer: Any, ear: int, warn: Any) -> Any:
        made.update(tap=tap, writer=writer, rest=os.read(ear, 100))
        return SimpleNamespace(run=lambda: made.update(ran=True))

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setattr(blackbox, "_stand_back", lambda: made.update(stood_back=True))
    monkeypatch.setattr(blackbox, "Node", join)
    monkeypatch.setattr(blackbox, "BlackBox", box)
    monkeypatch.setattr(blackbox, "open_session", open_bus)
    monkeypatch.setattr(blackbox, "Tap", listen)
    monkeypatch.setattr(blackbox, "Writer", lambda robot, folder: (robot, folder))
    monkeypatch.setattr(signal, "signal", lambda number, handler: made["handled"].update({number: handler}))
    return made


@pytest.fixture
def run(made: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    """Run it with the settings on its stdin, and something after them."""
    ear, mouth = os.pipe()
    os.write(mouth, msgspec.json.encode(SETTINGS) + b"\nend\n")
    monkeypatch.setattr(blackbox.sys, "stdin", SimpleNamespace(fileno=lambda: ear))
    assert blackbox.run() == 0
    yield made
    os.close(ear)
    os.close(mouth)


def test_it_joins_by_the_robots_door_and_keeps_a_files_place(run: dict[str, Any], tmp_path: Path) -> None:
    assert (run["name"], run["node"].robot, run["bus"].connect) == (
        "blackbox",
        "archangel",
        SETTINGS.bus.connect,
    )
    assert run["tap"][:2] == ("session", "archangel")
    assert run["writer"] == ("archangel", tmp_path / "zteleop/robots/archangel/blackbox")
    assert run["ran"]
    assert run["left"]
    assert run["stood_back"]


def test_what_follows_the_settings_is_left_to_be_heard(run: dict[str, Any]) -> None:
    assert run["rest"] == b"end\n"


def test_a_signal_ends_it_in_order(run: dict[str, Any]) -> None:
    assert set(signals.ENDING) <= run["held"], "one that comes before it listens waits"
    assert not set(signals.ENDING) & signal.pthread_sigmask(signal.SIG_BLOCK, [])
    run["handled"][signal.SIGTERM](signal.SIGTERM, None)
    assert run["node"].stopped


def test_each_source_that_drives_has_room_of_its_own() -> None:
    paths = blackbox._paths(SETTINGS)
    assert {"pwm/keyboard", "cmd_vel/program", "stop", "drive_status", "odom"} <= set(paths)
    assert "pwm" not in paths
    assert len(paths) < TOPICS_AT_MOST / 2
