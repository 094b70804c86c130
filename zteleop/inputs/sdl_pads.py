"""Gamepads through SDL, for macOS: it is asked where each control is, and tells nothing by itself."""

import os
import threading
from collections.abc import Mapping
from typing import Any, NamedTuple, Self

from zteleop.control.proof import NEVER
from zteleop.errors import DeviceError, install
from zteleop.inputs.gamepad_map import FORGET, Moved
from zteleop.machine import signals

LOOK_EVERY = 0.02
"""s between two looks: SDL has no file that turns readable"""
SETTLES = 0.3
"""s after which it is known what is held on a pad that came: at first SDL takes each control as at rest"""
FULL = 32767
BUTTONS = {
    **{"a": "BTN_SOUTH", "b": "BTN_EAST", "x": "BTN_NORTH", "y": "BTN_WEST", "back": "BTN_SELECT"},
    **{"guide": "BTN_MODE", "start": "BTN_START", "leftstick": "BTN_THUMBL", "rightstick": "BTN_THUMBR"},
    **{"leftshoulder": "BTN_TL", "rightshoulder": "BTN_TR"},
}
"""SDL's name to Linux's; a button's place in this order is its number, as it is of the axes"""
STICKS = {"leftx": "ABS_X", "lefty": "ABS_Y", "rightx": "ABS_RX", "righty": "ABS_RY"}
TRIGGERS = {"lefttrigger": "ABS_Z", "righttrigger": "ABS_RZ"}
CROSS = {"ABS_HAT0X": ("dpleft", "dpright"), "ABS_HAT0Y": ("dpup", "dpdown")}
"""which two buttons Linux takes for one axis"""
NUMBERS = {name: i for i, name in enumerate((*BUTTONS, "dpup", "dpdown", "dpleft", "dpright"))}
AXES = {name: i for i, name in enumerate((*STICKS, *TRIGGERS))}
QUIET = {
    "PYGAME_HIDE_SUPPORT_PROMPT": "1",
    "SDL_VIDEODRIVER": "dummy",  # it needs one, and no window
    "SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS": "1",  # the terminal has the focus
    "SDL_NO_SIGNAL_HANDLERS": "1",  # Ctrl-C is ours
}


class Sdl(NamedTuple):
    """What is used of pygame."""

    pump: Any
    """lets SDL look at its devices"""
    controllers: Any
    quit: Any


class SdlPads:
    """The first pad whose name holds `which`; when it is unplugged the next, or none until one comes.

    Entering raises DeviceError where there is no pygame.
    """

    def __init__(self, which: str = "") -> None:
        self._which = which.casefold()
        self._sdl: Sdl | None = None
        self._ticks: Ticks | None = None
        self._pad: Any = None
        self._came = NEVER
        self._at: dict[str, float] = {}

    def __enter__(self) -> Self:
        self._sdl = _sdl()
        self._ticks = Ticks(LOOK_EVERY)
        return self

    def __exit__(self, *exc: object) -> None:
        if self._ticks:
            self._ticks.close()
            self._ticks = None
        self._pad = None
        if self._sdl:
            self._sdl.quit()
            self._sdl = None

    @property
    def name(self) -> str:
        """The name of the pad in use; empty while there is none, or nobody knows what is held on it."""
        return self._pad.name if self._pad and self._at else ""

    @property
    def trouble(self) -> str:
        """Why there is none although one is plugged in, in a sentence."""
        if self._pad or not self._sdl or not self._sdl.controllers.get_count() or self._open():
            return ""
        return (
            "SDL knows no layout of what is plugged in; a mapping in SDL_GAMECONTROLLERCONFIG tells it, "
            "and zteleop gamepad --list shows the pads it knows"
        )

    @property
    def names(self) -> list[str]:
        """The pads there are."""
        if self._sdl:
            self._sdl.pump()
        return [pad.name for pad in self._open()]

    def fileno(self) -> int:
        """Return what turns readable when it is time to look."""
        return self._ticks.fileno() if self._ticks else -1

    def read(self, now: float) -> list[Moved]:
        """Return what moved, without blocking; after FORGET, where each control of the pad is."""
        if not self._sdl or not self._ticks:
            return []
        self._ticks.heed()
        self._sdl.pump()
        if self._pad and not self._pad.attached():
            self._pad = None
            self._at = {}
            return [FORGET, *self._next(now)]
        return self._moves(now) if self._pad else self._next(now)

    def _next(self, now: float) -> list[Moved]:
        self._pad = next((pad for pad in self._open() if self._which in pad.name.casefold()), None)
        self._came = now
        return []

    def _moves(self, now: float) -> list[Moved]:
        if now - self._came < SETTLES:
            return []
        before, self._at = self._at, places(self._pad)
        moved = [Moved(name, at) for name, at in self._at.items() if before.get(name) != at]
        return moved if before else [FORGET, *moved]

    def _open(self) -> list[Any]:
        """Return the pads whose layout SDL knows."""
        if not self._sdl:
            return []
        known = self._sdl.controllers
        return [known.Controller(i) for i in range(known.get_count()) if known.is_controller(i)]


class Ticks:
    """A file that turns readable again and again."""

    def __init__(self, period: float) -> None:
        self._ear, self._bell = os.pipe()
        os.set_blocking(self._ear, False)
        self._heard = threading.Event()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._tick, args=(period,), name="sdl ticks", daemon=True)
        signals.start(self._thread)

    def fileno(self) -> int:
        return self._ear

    def heed(self) -> None:
        """Wait for the next tick."""
        try:
            os.read(self._ear, 64)
        except BlockingIOError:
            return
        self._heard.set()

    def close(self) -> None:
        self._ended.set()
        self._heard.set()
        self._thread.join()
        os.close(self._bell)
        os.close(self._ear)

    def _tick(self, period: float) -> None:
        while not self._ended.wait(period):
            self._heard.clear()
            if self._ended.is_set():  # it was just now, and what that set besides is cleared again
                return
            os.write(self._bell, b".")
            self._heard.wait()  # one at a time: whoever stands still is not flooded


def places(pad: Any) -> dict[str, float]:
    """Return where each control is that the pad has, by Linux's name: an axis -1 to 1, a button 0 or 1."""
    has: Mapping[str, str] = pad.get_mapping()
    at = {BUTTONS[name]: float(pad.get_button(NUMBERS[name])) for name in BUTTONS if name in has}
    for name, axis in STICKS.items():
        if name in has:
            at[axis] = max(-1.0, pad.get_axis(AXES[name]) / FULL)
    for name, axis in TRIGGERS.items():
        if name in has:
            at[axis] = 2 * pad.get_axis(AXES[name]) / FULL - 1  # Linux's is -1 at rest
    for axis, (less, more) in CROSS.items():
        if less in has and more in has:
            at[axis] = float(pad.get_button(NUMBERS[more]) - pad.get_button(NUMBERS[less]))
    return at


def _sdl() -> Sdl:
    for name, value in QUIET.items():
        os.environ.setdefault(name, value)
    try:
        import pygame
        from pygame._sdl2 import controller
    except ImportError as error:
        raise DeviceError(
            f"pads are read through SDL here, which is not installed; say: {install('pad')}"
        ) from error
    pygame.display.init()
    controller.init()

    def end() -> None:
        controller.quit()
        pygame.display.quit()

    return Sdl(pygame.event.get, controller, end)
