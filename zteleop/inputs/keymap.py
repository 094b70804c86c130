"""Which key does what; the configuration adds to it."""

from collections.abc import Collection, Mapping
from typing import Literal

from zteleop.errors import ConfigError
from zteleop.inputs.levers import Axis

KEYS: dict[str, str] = {
    **{"up": "forward", "down": "reverse", "left": "left", "right": "right"},
    **{"w": "forward", "s": "reverse", "a": "left", "d": "right"},
    **{"space": "stop", "x": "neutral"},
    **{"backspace": "stop robot", "r": "release robot"},
    **{"u": "faster", "j": "slower", "i": "turn faster", "k": "turn slower"},
    **{"q": "quit", "ctrl-c": "quit", "ctrl-z": "suspend", "ctrl-l": "redraw", "?": "help"},
}
DOES: dict[str, str] = {
    **{"forward": "forward", "reverse": "reverse", "left": "to the left", "right": "to the right"},
    **{"stop": "throttle off", "neutral": "throttle off, wheels straight"},
    **{"stop robot": "STOP the robot, until it is released", "release robot": "release a stop"},
    **{"faster": "faster, by a tenth", "slower": "slower"},
    **{"turn faster": "turn faster", "turn slower": "turn slower"},
    **{"quit": "neutral, and quit", "suspend": "neutral, and back to the shell; fg goes on"},
    **{"redraw": "draw the screen anew", "help": "show these keys, or hide them"},
}
"""What each action does, in words."""
DIRECTIONS: dict[str, tuple[Axis, int]] = {
    "forward": ("throttle", 1),
    "reverse": ("throttle", -1),
    "left": ("steering", 1),
    "right": ("steering", -1),
}

HOW = {"step": ", a step each press", "hold": ", while it is held"}
SPEEDS = {"faster", "slower", "turn faster", "turn slower"}
"""Of a full stick; levers know none."""


def bindings(keys: Mapping[str, str], actions: Collection[str]) -> dict[str, str]:
    """Return the keys bound here beside the usual ones; ConfigError for an action there is not."""
    for key, action in keys.items():
        if action not in actions:
            raise ConfigError(
                f"key {key!r} is bound to {action!r}; expected one of {', '.join(sorted(actions))}"
            )
    return {**KEYS, **keys}


def describe(keys: Mapping[str, str], drive: Literal["step", "hold"] | None = None) -> list[tuple[str, str]]:
    """Return the keys of each action and what they do, in the order of `DOES`, when they drive so."""
    how = HOW[drive] if drive else ""
    told = []
    for action, does in DOES.items():
        bound = [key for key, act in keys.items() if act == action]
        if bound and not (drive == "step" and action in SPEEDS):
            told.append((" ".join(bound), does + (how if action in DIRECTIONS else "")))
    return told
