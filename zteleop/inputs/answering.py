"""Keys of somebody who turns one servo at a time, and answers: which turn it, and which are answers."""

from zteleop.control.measuring import Axis
from zteleop.terminal.any_terminal import AnyTerminal
from zteleop.terminal.keys import Key
from zteleop.terminal.typed import Keys, Tells

TURNS: dict[Axis, tuple[str, str]] = {"steering": ("left", "right"), "throttle": ("up", "down")}
"""the keys that turn each servo one tick: they turn no other while it is asked for"""
FAR = ("pageup", "pagedown")
"""the same, ten ticks at once"""
TEN = 10
ANSWERS = ("enter", "s", "b")


class Answering:
    """Keys, without the answers among them, and without those that turn what is not asked for."""

    def __init__(self, keys: Keys) -> None:
        self._keys = keys
        self.terminal: AnyTerminal = keys.terminal
        self.axis: Axis = "throttle"
        self.drives = False
        """the other servo is turned as well"""
        self.answers: list[str] = []
        """typed since they were last taken"""

    @property
    def ended(self) -> bool:
        """The terminal hung up."""
        return self._keys.ended

    @property
    def releases(self) -> Tells:
        """Whether releases are told."""
        return self._keys.releases

    def fileno(self) -> int | None:
        """Return what turns readable when something happened to a key."""
        return self._keys.fileno()

    def read(self, now: float) -> list[Key]:
        """Return what happened to keys since, without blocking."""
        kept = []
        for key in self._keys.read(now):
            if key.name in ANSWERS and key.event == "press":
                self.answers.append(key.name)
            kept += self._turning(key)
        return kept

    def went_on(self, now: float) -> bool:
        """Say, once, that the process was stopped and went on."""
        return self._keys.went_on(now)

    def suspend(self, now: float) -> None:
        """Stop the process, and return when it goes on."""
        self._keys.suspend(now)

    def close(self) -> None:
        """Let go of everything but the terminal."""
        self._keys.close()

    def _turning(self, key: Key) -> list[Key]:
        """Return what a key is to a keyboard that knows two directions."""
        turns = TURNS[self.axis]
        if key.name in FAR:
            return [key._replace(name=turns[FAR.index(key.name)])] * TEN if key.event != "release" else []
        others = set() if self.drives else {name for names in TURNS.values() for name in names} - {*turns}
        return [] if key.name in others else [key]
