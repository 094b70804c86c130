"""A terminal's keys, with their releases from the keyboards of this machine.

A press counts only when the terminal has it as well, so what is typed elsewhere drives nothing; a release
is the device's word, whatever has the focus by then.
"""

from collections.abc import Iterable, Iterator
from selectors import EVENT_READ, DefaultSelector
from typing import NamedTuple, Protocol

from zteleop.errors import DeviceError
from zteleop.inputs.evdev.codes import ALTS, CTRLS, EV_KEY, KEYS, SHIFTS, SUPERS, TYPED
from zteleop.inputs.evdev.device import RESYNC, Event
from zteleop.inputs.evdev.devices import Change, Devices, may_not_read
from zteleop.terminal.keys import Key
from zteleop.terminal.typed import Typed

LATE = 0.2
"""s after a press on a device in which the terminal has it, too"""
EARLY = 0.05
"""s that the terminal may have it before the device is read"""
SILENT = SHIFTS | CTRLS | ALTS | SUPERS | {58, 69, 70}
"""codes of keys that a terminal never tells by themselves: what is held with others, and the locks"""
NOBODY = "expected a keyboard at this machine, found none; over ssh the keys are at another one"
Code = tuple[str, int]
"""a device's path, and the number of a key"""


class Source(Protocol):
    """Where devices are: what `Devices` is of this module."""

    refused: dict[str, str]

    def fileno(self) -> int: ...
    def read(self, now: float) -> list[Change]: ...
    def close(self) -> None: ...


class Pressed(NamedTuple):
    """A press that one side has told of, and the other not yet."""

    at: float
    code: Code
    up: bool = False
    """It was let go since."""


class ToldKeys:
    """What `Typed` is, for a terminal that tells no releases.

    Raises DeviceError where no keyboard can be read.
    """

    def __init__(self, typed: Typed, devices: Source | None = None) -> None:
        self._typed = typed
        self._devices: Source = devices or Devices(is_keyboard)
        self._open: set[str] = set()
        self._down: set[Code] = set()
        self._untold: list[Pressed] = []
        """pressed on a device, and not told by the terminal so far"""
        self._unseen: list[tuple[float, Key]] = []
        """told by the terminal, and not seen on a device so far"""
        self._held: dict[str, Code] = {}
        self._let_go: list[str] = []
        self._layout: dict[str, int] = {}
        """which key types what, as far as it was seen"""
        self._files: DefaultSelector | None = None
        self.terminal = typed.terminal
        self.releases = Told(self)
        self._take(self._devices.read(float("-inf")), 0.0)
        if not self._open:
            refused = self._devices.refused
            self._devices.close()
            raise DeviceError(may_not_read(refused, "a keyboard") if refused else NOBODY)

    @property
    def ended(self) -> bool:
        """The terminal hung up."""
        return self._typed.ended

    @property
    def told(self) -> bool:
        """There is a keyboard that tells."""
        return bool(self._open)

    def fileno(self) -> int:
        """Return what turns readable when a device or the terminal, which must be open, speaks."""
        if self._files is None:
            self._files = DefaultSelector()
            for file in (self._typed.fileno(), self._devices.fileno()):
                self._files.register(file, EVENT_READ)
        return self._files.fileno()

    def read(self, now: float) -> list[Key]:
        """Return what happened to keys since, without blocking."""
        self._unseen += [(now, key) for key in self._typed.read(now) if key.event != "release"]
        self._take(self._devices.read(now), now)
        return [*self._releases(), *self._presses(now)]

    def went_on(self, now: float) -> bool:
        """Say, once, that the process was stopped and went on: nobody saw which keys were let go."""
        return self._typed.went_on(now)

    def suspend(self, now: float) -> None:
        """Stop the process, and return when it goes on; what is held is forgotten."""
        self._typed.suspend(now)
        self._held.clear()

    def close(self) -> None:
        """Let go of the devices."""
        if self._files:
            self._files.close()
            self._files = None
        self._devices.close()

    def _take(self, changes: list[Change], now: float) -> None:
        """Take in what happened on the devices."""
        for change in changes:
            path = change.device.path
            if change.what == "unplugged":
                self._open.discard(path)
                self._lift(code for code in [*self._down] if code[0] == path)
                continue
            self._open.add(path)
            for event in change.events:
                if event == RESYNC:  # a release may be among what was lost
                    self._lift(code for code in [*self._down] if code[0] == path)
                elif event.type == EV_KEY:
                    self._move((path, event.code), event, now)

    def _move(self, code: Code, event: Event, now: float) -> None:
        if event.value == 0:
            self._lift([code])
        elif event.value == 1:
            self._down.add(code)
            if event.code not in SILENT:
                self._untold.append(Pressed(now, code))

    def _lift(self, codes: Iterable[Code]) -> None:
        """Take in that keys are up."""
        for code in codes:
            self._down.discard(code)
            self._untold = [one._replace(up=one.up or one.code == code) for one in self._untold]
            self._let_go += [name for name, held in self._held.items() if held == code]

    def _releases(self) -> Iterator[Key]:
        names, self._let_go = self._let_go, []
        for name in names:
            if self._held.pop(name, None):
                yield Key(name, "release", place_of(name))

    def _presses(self, now: float) -> Iterator[Key]:
        """Yield what the terminal has told, as far as a device says so as well."""
        self._untold = [one for one in self._untold if now - one.at <= LATE]
        waiting, self._unseen = self._unseen, []
        for at, key in waiting:
            code = self._held.get(key.name)
            if code in self._down:
                yield Key(key.name, "repeat", place_of(key.name))
            elif match := self._match(key):
                self._untold.remove(match)
                yield Key(key.name, "press", place_of(key.name))
                if match.up:
                    yield Key(key.name, "release", place_of(key.name))
                else:
                    self._held[key.name] = match.code
            elif now - at <= EARLY:
                self._unseen.append((at, key))

    def _match(self, key: Key) -> Pressed | None:
        """Return the press on a device that a terminal's key is; None where that is not certain.

        Which key types what is learned when one is pressed alone: a repeat that comes late, after its
        release, is never taken for another key that was pressed meanwhile.
        """
        types = key.name.rpartition("-")[2].lower() or key.name
        code = self._layout.get(types)
        alone = len(self._untold) == 1 and self._down <= {self._untold[0].code}
        if code is None and alone:
            self._layout[types] = self._untold[0].code[1]
            return self._untold[0]
        wanted = [one for one in self._untold if one.code[1] == code]
        if code is None:
            wanted = [one for one in self._untold if KEYS.get(one.code[1]) == types]
        return next(iter(wanted), None)


class Told:
    """What `Releases` says, where the devices tell."""

    focused = True
    known = True

    def __init__(self, keys: ToldKeys) -> None:
        self.how = "this machine's keyboard"
        self._keys = keys

    @property
    def told(self) -> bool:
        """It is told when a key is let go."""
        return self._keys.told

    def ping(self, now: float) -> None:
        """Ask nobody: a device that is gone is told of."""

    def is_silent(self, now: float) -> bool:
        """Say that it never is."""
        return False


def place_of(name: str) -> str:
    """Return by which a release is known to be of a press."""
    return f"key {name}"


def is_keyboard(keys: frozenset[int], axes: frozenset[int], name: str) -> bool:
    """Say whether a device has letters: no power button, and no mouse with keys."""
    return keys >= TYPED and not axes
