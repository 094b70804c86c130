import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest

from zteleop.bus.settings import BusSettings
from zteleop.config import Config
from zteleop.control.standing import Standing
from zteleop.errors import ConfigError, DeviceError
from zteleop.machine import link
from zteleop.processes import PROGRAMS, actuator
from zteleop.testing import FakeNode


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """What the actuator was made of."""
    made: dict[str, Any] = {}

    @contextmanager
    def join(name: str, robot: str, bus: BusSettings) -> Iterator[FakeNode]:
        made.update(name=name, bus=bus, node=FakeNode(name, robot))
        yield made["node"]
        made["left"] = True

    def obeyer(
        node: Any,
        drive: Any,
        driver: Any,
        end: Any,
        stop_file: Any,
        limits_file: Any,
        journal: Any,
        health: Any,
        standing: Any,
    ) -> Any:
        made.update(drive=drive, end=end, stop=stop_file.path, journal=journal, health=health)
        made.update(standing=standing)
        return SimpleNamespace(run=lambda: made.update(ran=True))

    def open_driver(name: str, settings: Any, *, exclusive: bool) -> str:
        made.update(driver=name, settings=settings, exclusive=exclusive)
        return "driver"

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setattr(
        actuator.realtime, "ask_for", lambda priority, score: made.update(asked=priority) or []
    )
    monkeypatch.setattr(link, "adopt", lambda number: f"end {number}")
    monkeypatch.setattr(actuator, "Node", join)
    monkeypatch.setattr(actuator, "Actuator", obeyer)
    monkeypatch.setattr(actuator, "Journal", lambda folder, detail, warn: (folder, detail))
    monkeypatch.setattr(actuator, "Health", lambda root, log: str(root))
    monkeypatch.setattr(actuator, "open_driver", open_driver)
    return made


def give(monkeypatch: pytest.MonkeyPatch, settings: bytes) -> None:
    monkeypatch.setattr(actuator.sys, "stdin", SimpleNamespace(buffer=io.BytesIO(settings)))


SETTINGS = Config(
    robot="archangel",
    bus=BusSettings(mode="client", connect=["door//tmp/x/door"], multicast=False),
    journal="all",
    drivers={"simulated": {"path": "/tmp/chip"}},
)


def test_it_begins_in_the_place_it_is_given(made: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    standing = Standing(5, 1.0, 2.0, 3.0, 2, 7, 4.0, 5.0)
    give(monkeypatch, msgspec.json.encode(SETTINGS) + b"\n" + msgspec.json.encode(standing))
    assert actuator.run(7) == 0
    assert made["standing"] == standing


def test_it_obeys_with_the_settings_it_is_given_and_its_parents_lock(
    made: dict[str, Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    give(monkeypatch, msgspec.json.encode(SETTINGS) + b"\nnull")
    assert actuator.run(7) == 0
    assert made["standing"] is None
    assert (made["name"], made["node"].robot, made["bus"]) == ("actuator", "archangel", SETTINGS.bus)
    assert (made["drive"], made["end"]) == (SETTINGS.drive, "end 7")
    assert (made["driver"], made["settings"], made["exclusive"]) == (
        "simulated",
        {"path": "/tmp/chip"},
        False,
    )
    folder = tmp_path / "zteleop" / "robots" / "archangel"
    assert (made["stop"], made["journal"], made["health"]) == (folder / "stop", (folder, "all"), "/sys")
    assert made["ran"]
    assert made["left"]


def test_it_ranks_below_its_watchdog(made: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    give(monkeypatch, msgspec.json.encode(SETTINGS))
    actuator.run(7)
    assert made["asked"] < PROGRAMS["watchdog"].priority
    assert actuator.PROGRAM.oom_score > PROGRAMS["watchdog"].oom_score


def test_a_chip_that_is_missing_leaves_the_bus(made: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object, **__: object) -> None:
        raise DeviceError("nobody answers")

    monkeypatch.setattr(actuator, "open_driver", missing)
    give(monkeypatch, msgspec.json.encode(SETTINGS))
    with pytest.raises(DeviceError, match="nobody answers"):
        actuator.run(7)
    assert "ran" not in made


@pytest.mark.parametrize(
    "orders",
    [b"", b"{", b"null", b'{"robot":"../x"}', b'{"robot":"\xff"}', b'{"drivers":' * 5000, b'{"x":1}'],
)
def test_orders_that_are_none_are_refused_in_words(orders: bytes) -> None:
    with pytest.raises(ConfigError, match=r"^expected a watchdog's settings on standard input: "):
        actuator.orders(orders)


@pytest.mark.parametrize("number", [-1, 10**20, 987654])
def test_a_link_that_is_none_is_refused_in_words(number: int) -> None:
    with pytest.raises(DeviceError, match=f"file {number} is no watchdog's; zteleop actuator starts both"):
        actuator._adopt(number)
