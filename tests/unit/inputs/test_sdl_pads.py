"""Pads through SDL: a pad of its own making, and a clock that the test moves."""

import builtins
import os
import select
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from virtual_pad import VirtualPad

from zteleop.control.stick import Stick
from zteleop.errors import DeviceError
from zteleop.inputs.gamepad import Gamepad
from zteleop.inputs.gamepad_map import FORGET
from zteleop.inputs.sdl_pads import LOOK_EVERY, SETTLES, SdlPads, Ticks

JOYSTICK = 0
"""one that SDL does not know as a gamepad"""


@pytest.fixture
def pads() -> Iterator[SdlPads]:
    with SdlPads() as pads:
        yield pads


@pytest.fixture
def pad(pads: SdlPads) -> Iterator[VirtualPad]:
    pad = VirtualPad()
    yield pad
    pad.unplug()


def look(pads: SdlPads, now: float) -> dict[str, float]:
    return {moved.name: moved.value for moved in pads.read(now)}


def settled(pads: SdlPads) -> None:
    pads.read(0.0)
    assert pads.read(SETTLES)[0] == FORGET


def test_a_pad_has_linux_s_names_for_its_controls(pads: SdlPads, pad: VirtualPad) -> None:
    pad.plug("Test Pad")
    assert (pads.read(0.0), pads.name) == ([], ""), "nobody knows yet what is held on it"
    found = pads.read(SETTLES)
    assert found[0] == FORGET
    at = dict(found[1:])
    assert at.pop("ABS_Z") == at.pop("ABS_RZ") == pytest.approx(-1.0, abs=0.01), "triggers, let go of"
    assert set(at) == {
        *("BTN_SOUTH", "BTN_EAST", "BTN_NORTH", "BTN_WEST", "BTN_SELECT", "BTN_MODE", "BTN_START"),
        *("BTN_THUMBL", "BTN_THUMBR", "BTN_TL", "BTN_TR"),
        *("ABS_X", "ABS_Y", "ABS_RX", "ABS_RY", "ABS_HAT0X", "ABS_HAT0Y"),
    }
    assert set(at.values()) == {0.0}
    assert (pads.name, pads.names, pads.trouble) == ("Test Pad", ["Test Pad"], "")


@pytest.mark.parametrize(
    ("control", "to", "name"),
    [
        ("leftshoulder", 1.0, "BTN_TL"),
        ("a", 1.0, "BTN_SOUTH"),
        ("b", 1.0, "BTN_EAST"),
        ("start", 1.0, "BTN_START"),
        ("leftx", -1.0, "ABS_X"),
        ("lefty", -1.0, "ABS_Y"),
        ("righttrigger", 1.0, "ABS_RZ"),
    ],
)
def test_what_moves_is_told_once(pads: SdlPads, pad: VirtualPad, control: str, to: float, name: str) -> None:
    pad.plug("Test Pad")
    settled(pads)
    pad.move(control, to)
    assert look(pads, 1.0) == {name: pytest.approx(to, abs=0.001)}
    assert pads.read(1.1) == []


def test_a_pad_that_is_unplugged_is_forgotten_and_the_next_one_found(pads: SdlPads, pad: VirtualPad) -> None:
    pad.plug("Test Pad")
    settled(pads)
    pad.unplug()
    assert pads.read(1.0) == [FORGET]
    assert (pads.name, pads.names, pads.read(2.0)) == ("", [], [])
    pad.plug("Another")
    pads.read(3.0)
    assert pads.read(4.0)[0] == FORGET
    assert pads.name == "Another"


def test_what_is_held_when_a_pad_comes_moves_nothing(pads: SdlPads, pad: VirtualPad) -> None:
    gamepad = Gamepad(pads)
    pad.plug("Test Pad")
    gamepad.read(0.0)
    gamepad.read(0.05)
    pad.move("leftshoulder", 1)  # which SDL tells only now
    pad.move("lefty", -1.0)
    for now in (0.1, 0.2, SETTLES, 0.5):
        assert not gamepad.read(now)
        assert gamepad.stick(now) == Stick()
    assert gamepad.words == "Test Pad: let go of LB and of the sticks before you drive"
    pad.move("leftshoulder", 0)
    pad.move("lefty", 0.0)
    assert not gamepad.read(0.6)
    pad.move("leftshoulder", 1)
    pad.move("lefty", -1.0)
    assert gamepad.read(0.7)
    assert gamepad.stick(0.7).forward == pytest.approx(1.0, abs=0.001)


def test_only_the_pad_named_is_meant() -> None:
    with SdlPads("other") as pads:
        pad = VirtualPad()
        pad.plug("Test Pad")
        assert (pads.read(0.0), pads.read(1.0), pads.name) == ([], [], "")
        pad.unplug()
        pad.plug("Another")
        assert (pads.read(2.0), pads.read(3.0)[0], pads.name) == ([], FORGET, "Another")
        pad.unplug()


def test_a_joystick_without_a_layout_is_named_as_the_trouble(pads: SdlPads, pad: VirtualPad) -> None:
    pad.plug("Stick", kind=JOYSTICK)
    pads.read(0.0)
    assert "SDL_GAMECONTROLLERCONFIG" in pads.trouble
    assert "SDL_GAMECONTROLLERCONFIG" in Gamepad(pads).words


def test_without_pygame_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name.startswith("pygame"):
            raise ModuleNotFoundError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(DeviceError, match=r"pip install .*\[pad\]'"):
        SdlPads().__enter__()


def test_it_wakes_whoever_waits_and_never_floods_them(pads: SdlPads) -> None:
    assert select.select([pads.fileno()], [], [], 2.0)[0]
    pads.read(0.0)
    assert select.select([pads.fileno()], [], [], 2.0)[0], "and again"


def test_ticks_come_one_at_a_time_and_end() -> None:
    before = threading.active_count()
    ticks = Ticks(LOOK_EVERY)
    assert select.select([ticks.fileno()], [], [], 2.0)[0]
    time.sleep(5 * LOOK_EVERY)
    assert os.read(ticks.fileno(), 64) == b".", "who stands still meanwhile"
    ticks.heed()  # nothing to hear: no harm
    ticks.close()
    assert threading.active_count() == before


def test_a_clock_that_is_closed_at_the_very_moment_of_a_tick_ends() -> None:
    ticks = Ticks(0.01)
    clear = ticks._heard.clear

    def closed_before() -> None:
        ticks._ended.set()
        ticks._heard.set()
        clear()

    ticks._heard.clear = closed_before  # type: ignore[method-assign]
    ticks._heard.set()  # where it waits for the first tick to be heard already
    ticks._thread.join(5.0)
    assert not ticks._thread.is_alive()
    ticks.close()
