"""Which key does what; the configuration adds to it."""

from collections.abc import Collection, Mapping

from zteleop.errors import ConfigError
from zteleop.inputs.levers import Axis

KEYS: dict[str, str] = {
    **{"up": "forward", "down": "reverse", "left": "left", "right": "right"},
    **{"w": "forward", "s": "reverse", "a": "left", "d": "right"},
    **{"space": "stop", "x": "neutral"},
    **{"backspace": "stop robot", "r": "release robot"},
    **{"u": "faster", "j": "slower", "i": "turn faster", "k": "turn slower"},
    **{"q": "quit", "ctrl-c": "quit", "ctrl-z": "suspend", "ctrl-l": "redraw"},
}
DIRECTIONS: dict[str, tuple[Axis, int]] = {
    "forward": ("throttle", 1),
    "reverse": ("throttle", -1),
    "left": ("steering", 1),
    "right": ("steering", -1),
}


def bindings(keys: Mapping[str, str], actions: Collection[str]) -> dict[str, str]:
    """Return the keys bound here beside the usual ones; ConfigError for an action there is not."""
    for key, action in keys.items():
        if action not in actions:
            raise ConfigError(
                f"key {key!r} is bound to {action!r}; expected one of {', '.join(sorted(actions))}"
            )
    return {**KEYS, **keys}
