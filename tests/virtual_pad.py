"""A pad that SDL itself makes up: everything above its drivers is real."""

import ctypes
from pathlib import Path
from typing import Any

BUTTONS = ("a", "b", "x", "y", "back", "guide", "start", "leftstick", "rightstick", "leftshoulder")
AXES = ("leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger")
GAMEPAD = 1


class Description(ctypes.Structure):
    """SDL_VirtualJoystickDesc of SDL 2."""

    _fields_ = (
        *((name, ctypes.c_uint16) for name in ("version", "type", "axes", "buttons", "hats")),
        *((name, ctypes.c_uint16) for name in ("vendor", "product", "padding")),
        *((name, ctypes.c_uint32) for name in ("button_mask", "axis_mask")),
        ("name", ctypes.c_char_p),
        *((name, ctypes.c_void_p) for name in ("userdata", "update", "player", "rumble")),
        *((name, ctypes.c_void_p) for name in ("rumble_triggers", "led", "effect")),
    )


class VirtualPad:
    """One pad at a time; for a process that has imported pygame, which brings SDL."""

    def __init__(self) -> None:
        maps = Path("/proc/self/maps").read_text().split()
        self._sdl = ctypes.CDLL(next(word for word in maps if "libSDL2-2" in word))
        self._sdl.SDL_JoystickAttachVirtualEx.argtypes = [ctypes.POINTER(Description)]
        self._sdl.SDL_JoystickFromInstanceID.restype = ctypes.c_void_p
        self._sdl.SDL_JoystickSetVirtualAxis.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int16]
        self._sdl.SDL_JoystickSetVirtualButton.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8]
        self._joystick: Any = None
        self._held: list[object] = []
        """what SDL keeps no copy of"""

    def plug(self, name: str, kind: int = GAMEPAD, buttons: int = 15) -> None:
        description = Description(version=1, type=kind, axes=6, buttons=buttons, name=name.encode())
        self._held.append(description)
        index = self._sdl.SDL_JoystickAttachVirtualEx(ctypes.byref(description))
        assert index >= 0, "SDL makes no virtual pads here"
        self._opened(index)
        for trigger in AXES[4:]:
            self.move(trigger, -1.0)

    def unplug(self) -> None:
        if self._joystick is not None:
            self._joystick = None
            assert self._sdl.SDL_JoystickDetachVirtual(0) == 0

    def move(self, control: str, to: float) -> None:
        """Put an axis to -1 to 1, or press a button with 1."""
        if control in AXES:
            self._sdl.SDL_JoystickSetVirtualAxis(self._joystick, AXES.index(control), round(to * 32767))
        else:
            self._sdl.SDL_JoystickSetVirtualButton(self._joystick, BUTTONS.index(control), round(to))

    def _opened(self, index: int) -> None:
        self._sdl.SDL_JoystickOpen.restype = ctypes.c_void_p
        self._joystick = self._sdl.SDL_JoystickOpen(index)
