"""Linux's numbers for keys, buttons and axes, and their names: linux/input-event-codes.h."""

EV_SYN, EV_KEY, EV_ABS = 0, 1, 3
SYN_REPORT, SYN_DROPPED = 0, 3
KEY_COUNT, ABS_COUNT = 0x300, 0x40

_ROWS = {
    1: ("escape", *"1234567890-=", "backspace", "tab"),
    16: (*"qwertyuiop[]", "enter", "ctrl"),
    30: (*"asdfghjkl;'`", "shift", "\\"),
    44: (*"zxcvbnm,./", "shift"),
    56: ("alt", "space", "capslock"),
    59: tuple(f"f{number}" for number in range(1, 11)),
    102: ("home", "up", "pageup", "left", "right", "end", "down", "pagedown", "insert", "delete"),
}
KEYS: dict[int, str] = {
    **{first + i: name for first, names in _ROWS.items() for i, name in enumerate(names)},
    **{55: "*", 69: "numlock", 70: "scrolllock", 86: "<", 87: "f11", 88: "f12", 96: "enter", 97: "ctrl"},
    **{98: "/", 99: "print", 100: "alt", 117: "=", 119: "pause", 125: "super", 126: "super", 127: "menu"},
    **{71: "7", 72: "8", 73: "9", 74: "-", 75: "4", 76: "5", 77: "6", 78: "+", 79: "1", 80: "2", 81: "3"},
    **{82: "0", 83: "."},
}
"""What a key types on a US keyboard; the keypad as if NumLock were on."""
SHIFTS = {42, 54}
CTRLS, ALTS, SUPERS = {29, 97}, {56, 100}, {125, 126}
TAB = 15
TYPED = {17, 30, 31, 32, 57}
"""w a s d and space: what has these is a keyboard, not a power button or a mouse with keys"""

AXES: dict[str, int] = {
    **{"ABS_X": 0, "ABS_Y": 1, "ABS_Z": 2, "ABS_RX": 3, "ABS_RY": 4, "ABS_RZ": 5},
    **{"ABS_THROTTLE": 6, "ABS_RUDDER": 7, "ABS_WHEEL": 8, "ABS_GAS": 9, "ABS_BRAKE": 10},
    **{f"ABS_HAT{i // 2}{'XY'[i % 2]}": 16 + i for i in range(8)},
}
_JOYSTICK = ("TRIGGER", "THUMB", "THUMB2", "TOP", "TOP2", "PINKIE", "BASE", "BASE2", "BASE3", "BASE4")
_GAMEPAD = ("SOUTH", "EAST", "C", "NORTH", "WEST", "Z", "TL", "TR", "TL2", "TR2", "SELECT", "START")
BUTTONS: dict[str, int] = {
    **{f"BTN_{name}": 0x120 + i for i, name in enumerate((*_JOYSTICK, "BASE5", "BASE6"))},
    "BTN_DEAD": 0x12F,
    **{f"BTN_{name}": 0x130 + i for i, name in enumerate((*_GAMEPAD, "MODE", "THUMBL", "THUMBR"))},
    **{f"BTN_DPAD_{name}": 0x220 + i for i, name in enumerate(("UP", "DOWN", "LEFT", "RIGHT"))},
    **{f"BTN_TRIGGER_HAPPY{i + 1}": 0x2C0 + i for i in range(40)},
}
NAMES: dict[tuple[int, int], str] = {
    **{(EV_ABS, code): name for name, code in AXES.items()},
    **{(EV_KEY, code): name for name, code in BUTTONS.items()},
}
"""(type, code) to the name of an axis or a button"""
