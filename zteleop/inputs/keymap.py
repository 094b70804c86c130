"""Which key does what: maps by name, to which the configuration adds."""

import re
from collections.abc import Mapping

from zteleop.errors import ConfigError, nearest
from zteleop.inputs import Drive
from zteleop.inputs.levers import Axis
from zteleop.terminal.keys import is_key, names

Moves = tuple[tuple[Axis, int], ...]
"""Which way a key pushes each axis; 1 is left, or forward."""
DIRECTIONS: dict[str, Moves] = {
    "forward": (("throttle", 1),),
    "reverse": (("throttle", -1),),
    "left": (("steering", 1),),
    "right": (("steering", -1),),
    "forward left": (("throttle", 1), ("steering", 1)),
    "forward right": (("throttle", 1), ("steering", -1)),
    "reverse left": (("throttle", -1), ("steering", 1)),
    "reverse right": (("throttle", -1), ("steering", -1)),
}
DOES: dict[str, str] = {
    **{"forward": "forward", "reverse": "reverse", "left": "to the left", "right": "to the right"},
    **{"forward left": "forward and left", "forward right": "forward and right"},
    **{"reverse left": "reverse and left", "reverse right": "reverse and right"},
    **{"stop": "throttle off", "neutral": "throttle off, wheels straight"},
    **{"stop robot": "STOP the robot, until it is released", "release robot": "release a stop"},
    **{"faster": "faster, by a tenth", "slower": "slower"},
    **{"turn faster": "turn faster", "turn slower": "turn slower"},
    **{"all faster": "drive and turn faster", "all slower": "drive and turn slower"},
    **{"quit": "neutral, and quit", "suspend": "neutral, and back to the shell; fg goes on"},
    **{"redraw": "draw the screen anew", "help": "show these keys, or hide them"},
    "nothing": "nothing",
}
"""What each action does, in words."""
HOW: dict[Drive, str] = {"step": ", a step each press", "hold": ", while it is held"}
SPEEDS = {"faster", "slower", "turn faster", "turn slower", "all faster", "all slower"}
"""Of a full stick; levers know none."""
TOGGLE = "toggle "
"""Before the name of a switch, which is said as true or false on the topic of that name."""
SWITCH = re.compile(r"[a-z][a-z0-9_]{0,30}")
OTHER = "other"
"""In a map, every key that is not in it."""

ARROWS = {"up": "forward", "down": "reverse", "left": "left", "right": "right"}
WASD = {"w": "forward", "s": "reverse", "a": "left", "d": "right"}
FASTER = {"u": "faster", "j": "slower", "i": "turn faster", "k": "turn slower"}
REST = {"space": "stop", "x": "neutral"}
ALWAYS = {
    **{"backspace": "stop robot", "r": "release robot"},
    **{"ctrl-c": "quit", "ctrl-z": "suspend", "ctrl-l": "redraw", "?": "help"},
}
QUIT = {"q": "quit"}
KEYMAPS: dict[str, dict[str, str]] = {
    "all": {**ARROWS, **WASD, **REST, **FASTER, **QUIT, **ALWAYS},
    "arrows": {**ARROWS, **REST, **FASTER, **QUIT, **ALWAYS},
    "wasd": {**WASD, **REST, **FASTER, **QUIT, **ALWAYS},
    "donkey": {**ARROWS, "space": "stop", **QUIT, **ALWAYS},  # the Donkeycar nodes
    "course": {**WASD, **FASTER, **QUIT, **ALWAYS, OTHER: "neutral"},  # the ROS 2 course on the Create 3
    "twist": {  # ROS' teleop_twist_keyboard
        **{"u": "forward left", "i": "forward", "o": "forward right"},
        **{"j": "left", "k": "neutral", "l": "right"},
        **{"m": "reverse left", ",": "reverse", ".": "reverse right"},
        **{"q": "all faster", "w": "faster", "e": "turn faster"},
        **{"z": "all slower", "x": "slower", "c": "turn slower"},
        **ALWAYS,
        OTHER: "neutral",
    },
    "stop": {**QUIT, **ALWAYS},  # no key drives: for whoever stands by, or has a pad in his hands
}

HELD = {"twist"}
"""maps that are made for driving while a key is held"""


def keymap(name: str) -> dict[str, str]:
    """Return a map that comes along; raises ConfigError with the nearest name."""
    if name not in KEYMAPS:
        raise ConfigError(f"no keymap {name!r}; {nearest(name, KEYMAPS)}")
    return KEYMAPS[name]


def bindings(keys: Mapping[str, str], name: str = "all") -> dict[str, str]:
    """Return the keys bound here beside those of a map; raises ConfigError for all that is wrong."""
    if wrong := [words for key, action in keys.items() if (words := _wrong(key, action))]:
        raise ConfigError("; ".join(wrong))
    found = {**keymap(name), **keys}
    if found["ctrl-c"] != "quit":
        raise ConfigError(f"key 'ctrl-c' quits, whatever else does; found {found['ctrl-c']!r}")
    if "stop robot" not in found.values():
        raise ConfigError("no key stops the robot; bind one to 'stop robot'")
    return found


def _wrong(key: str, action: str) -> str:
    """Return what is wrong with a key that is bound to an action, if anything."""
    if key != OTHER and not is_key(key):
        return f"no key is called {key!r}; {nearest(key, names())} (zteleop keys shows them)"
    if action.startswith(TOGGLE):
        is_name = SWITCH.fullmatch(action.removeprefix(TOGGLE))
        return "" if is_name else f"key {key!r}: a switch has a name such as lights_2, found {action!r}"
    if action not in DOES:
        return f"key {key!r}: no action {action!r}; {nearest(action, [*DOES, f'{TOGGLE}NAME'])}"
    return ""


def describe(keys: Mapping[str, str], drive: Drive | None = None) -> list[tuple[str, str]]:
    """Return the keys of each action and what they do, in the order of `DOES`, when they drive so."""
    how = HOW[drive] if drive else ""
    told = []
    for action, does in DOES.items():
        bound = [key if key != OTHER else "any other" for key, act in keys.items() if act == action]
        ways = (
            how
            if action in DIRECTIONS
            else ", with --drive hold"
            if drive == "step" and action in SPEEDS
            else ""
        )
        if bound:
            told.append((" ".join(bound), does + ways))
    return told + [(key, f"{act}, on or off") for key, act in keys.items() if act.startswith(TOGGLE)]


def switches(keys: Mapping[str, str]) -> list[str]:
    """Return the names of the switches that keys are bound to."""
    return [action.removeprefix(TOGGLE) for action in keys.values() if action.startswith(TOGGLE)]


def first_keys(keys: Mapping[str, str]) -> dict[str, str]:
    """Return for each action the key to name where there is room for one."""
    named = sorted((key for key in keys if key != OTHER), key=lambda key: key.startswith("ctrl-"))
    return {keys[key]: key for key in reversed(named)}
