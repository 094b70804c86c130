"""Gamepads and joysticks of Linux: its codes are the same for every pad that its drivers know."""

from typing import Self

from zteleop.errors import DeviceError
from zteleop.inputs.evdev.codes import AXES, BUTTONS, EV_ABS, EV_KEY, NAMES
from zteleop.inputs.evdev.device import RESYNC, Event, EventDevice, Range
from zteleop.inputs.evdev.devices import Devices, may_not_read
from zteleop.inputs.gamepad_map import FORGET, Moved

STICK = {AXES["ABS_X"], AXES["ABS_Y"]}
FIRST_BUTTON, LAST_BUTTON = 0x120, 0x13F
STYLUS = 0x14B


class EvdevPads:
    """The first pad whose name holds `which`; when it is unplugged the next, or none until one comes.

    Entering raises DeviceError where there is one that this user may not read, and no other.
    """

    def __init__(self, which: str = "") -> None:
        self._which = which.casefold()
        self._devices: Devices | None = None
        self._device: EventDevice | None = None
        self._ranges: dict[int, Range] = {}
        self._found: list[Moved] = []

    def __enter__(self) -> Self:
        self._devices = Devices(self._fits)
        try:
            self._found = self.read(float("-inf"))
            if self.trouble:
                raise DeviceError(self.trouble)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *exc: object) -> None:
        self._device = None
        if self._devices:
            self._devices.close()
            self._devices = None

    @property
    def name(self) -> str:
        """The name of the pad in use; empty while there is none."""
        return self._device.name if self._device else ""

    @property
    def trouble(self) -> str:
        """Why there is none although one is plugged in, in a sentence."""
        refused = self._devices.refused if self._devices else {}
        return may_not_read(refused, "a gamepad") if refused and not self._device else ""

    @property
    def names(self) -> list[str]:
        """The pads there are, the one in use first."""
        return [f"{device.name} ({device.path})" for device in self._devices.open] if self._devices else []

    def fileno(self) -> int:
        """Return what turns readable when a control moved."""
        return self._devices.fileno() if self._devices else -1

    def read(self, now: float) -> list[Moved]:
        """Return what moved, without blocking; after FORGET, where each control of the pad is."""
        moved, self._found = self._found, []
        for change in self._devices.read(now) if self._devices else []:
            if change.device is not self._device:
                continue
            if change.what == "unplugged":
                self._device = None
                moved.append(FORGET)
            else:
                moved += self._moves(change.device, change.events)
        if self._device is None:
            moved += self._next()
        return moved

    def _fits(self, keys: frozenset[int], axes: frozenset[int], name: str) -> bool:
        return is_pad(keys, axes) and self._which in name.casefold()

    def _next(self) -> list[Moved]:
        for device in self._devices.open if self._devices else ():
            try:
                self._ranges = {axis: device.range(axis) for axis in device.axes}
                found = self._state(device)
            except OSError:  # just gone: the next read says so
                continue
            self._device = device
            return [FORGET, *found]
        return []

    def _moves(self, device: EventDevice, events: list[Event]) -> list[Moved]:
        moved: list[Moved] = []
        for event in events:
            if event == RESYNC:
                moved += self._true_state(device)
            elif name := NAMES.get((event.type, event.code)):
                moved.append(Moved(name, self._value(event)))
        return moved

    def _true_state(self, device: EventDevice) -> list[Moved]:
        try:
            return self._state(device)
        except OSError:  # just gone: the next read says so
            return [FORGET]

    def _state(self, device: EventDevice) -> list[Moved]:
        """Return where every control is."""
        down = device.down()
        events = [Event(EV_KEY, code, code in down) for code in BUTTONS.values() if code in device.keys]
        events += [
            Event(EV_ABS, code, device.range(code).value) for code in AXES.values() if code in device.axes
        ]
        return [Moved(NAMES[event.type, event.code], self._value(event)) for event in events]

    def _value(self, event: Event) -> float:
        if event.type == EV_KEY:
            return float(event.value != 0)
        return self._ranges[event.code].fraction(event.value) if event.code in self._ranges else 0.0


def is_pad(keys: frozenset[int], axes: frozenset[int]) -> bool:
    """Say whether these are a stick with buttons beside it: no mouse, tablet or motion sensor."""
    buttons = any(FIRST_BUTTON <= key <= LAST_BUTTON for key in keys)
    return axes >= STICK and buttons and STYLUS not in keys
