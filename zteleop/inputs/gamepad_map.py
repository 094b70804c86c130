"""Which control of a pad does what: names as Linux has them, the same for every pad it knows as one."""

from collections.abc import Mapping
from typing import Annotated, NamedTuple, Protocol, Self

from msgspec import Meta, Struct

from zteleop.errors import ConfigError, nearest
from zteleop.inputs.evdev.codes import AXES, BUTTONS

PRESSED = 0.5
"""where an axis that is used as a button counts as pressed"""
STICKS = ("forward", "turn")
USES = (*STICKS, "deadman", "turbo", "stop", "release")
LABELS = {
    **{"BTN_TL": "LB", "BTN_TR": "RB", "BTN_TL2": "LT", "BTN_TR2": "RT", "ABS_Z": "LT", "ABS_RZ": "RT"},
    **{"BTN_SOUTH": "A", "BTN_EAST": "B", "BTN_NORTH": "X", "BTN_WEST": "Y", "BTN_START": "Start"},
    **{"BTN_SELECT": "Back", "BTN_THUMBL": "left stick", "BTN_THUMBR": "right stick"},
}
"""what is printed on most pads"""
OLDER = {"BTN_A": "BTN_SOUTH", "BTN_B": "BTN_EAST", "BTN_X": "BTN_NORTH", "BTN_Y": "BTN_WEST"}
"""the kernel's first names for the same buttons"""


class Moved(NamedTuple):
    """A control that moved, or where it was found."""

    name: str
    value: float
    """an axis -1 to 1, a button 0 or 1"""


FORGET = Moved("", 0.0)
"""Another pad, or none any more: what was known of the last one counts no more."""


class Pads(Protocol):
    """Where a pad is looked for and read, used in a `with`."""

    @property
    def name(self) -> str:
        """The name of the pad in use; empty while there is none."""

    @property
    def trouble(self) -> str:
        """Why there is none although one is plugged in, in a sentence."""

    @property
    def names(self) -> list[str]:
        """The pads there are."""

    def fileno(self) -> int | None:
        """Return what turns readable when a control moved; None where nothing does."""

    def read(self, now: float) -> list[Moved]:
        """Return what moved, without blocking; after FORGET, where each control of the pad is."""

    def __enter__(self) -> Self: ...
    def __exit__(self, *exc: object) -> None: ...


class Control(NamedTuple):
    """An axis or a button, and which way of it is meant."""

    name: str
    sign: int = 1

    def of(self, places: Mapping[str, float]) -> float:
        """Return where it is, -1 to 1; 0 on a pad without it."""
        return self.sign * places.get(self.name, 0.0)

    def pressed(self, places: Mapping[str, float]) -> bool:
        """Say whether it is pressed: a button, or an axis beyond half its way."""
        return self.of(places) > PRESSED

    @property
    def label(self) -> str:
        """What is printed on it."""
        return LABELS.get(self.name, self.name)


class GamepadSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """Axes are such as ABS_Y, or -ABS_Y the other way round; buttons such as BTN_TL, or an axis pushed."""

    forward: str = "-ABS_Y"
    """the axis that is 1 at full speed forward: up on a stick is -1 to the kernel"""
    turn: str = "-ABS_X"
    """the axis that is 1 at full left"""
    deadman: str = "BTN_TL"
    """held to drive"""
    turbo: str = "BTN_TR"
    """held to drive as fast as the robot can; empty for none"""
    stop: str = "BTN_EAST"
    """stops the robot; empty for none"""
    release: str = "BTN_START"
    """held for 1 s, ends the stop; empty for none"""
    deadzone: Annotated[float, Meta(ge=0, le=0.9)] = 0.1
    """of either side of a stick, where it counts as at rest"""
    silence: Annotated[float, Meta(ge=0.2, le=5)] = 5.0
    """s without any sign of life from the pad, after which it counts as let go"""
    device: str = ""
    """part of the name of the pad meant; empty for the first there is"""

    def __post_init__(self) -> None:
        for use in (*STICKS, "deadman"):
            if not getattr(self, use):
                raise ConfigError(_expected(use, ""))
        taken: dict[str, Control] = {}
        for use, control in self.controls.items():
            for other, its in taken.items():
                if its == control or (its.name == control.name and other in STICKS):
                    raise ConfigError(f"{use} and {other} are both {control.name}; each wants its own")
            taken[use] = control

    @property
    def controls(self) -> dict[str, Control]:
        """The controls by their use, without those left empty; raises ConfigError."""
        return {use: _control(use, text) for use in USES if (text := getattr(self, use))}


def rescale(value: float, deadzone: float) -> float:
    """Return a stick's way beyond its dead zone, -1 to 1, without a jump at its edge."""
    beyond = (abs(value) - deadzone) / (1 - deadzone)
    return min(1.0, beyond) * (1 if value > 0 else -1) if beyond > 0 else 0.0


def _control(use: str, text: str) -> Control:
    name = OLDER.get(text, text.removeprefix("-"))
    if name not in _known(use) or (text[:1] == "-" and name not in AXES):
        raise ConfigError(_expected(use, text))
    return Control(name, -1 if text[:1] == "-" else 1)


def _known(use: str) -> Mapping[str, int]:
    return AXES if use in STICKS else {**BUTTONS, **AXES}


def _expected(use: str, found: str) -> str:
    what = "an axis" if use in STICKS else "a button"
    near = nearest(found.removeprefix("-").upper(), _known(use))
    return f"expected {what} for {use}, found {found!r}; {near} (zteleop gamepad --learn finds them out)"
