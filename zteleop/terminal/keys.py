"""Bytes of a terminal to keys, one byte at a time.

Shift and the locks leave a key its name; ctrl and alt change it (`ctrl-up`, `alt-w`): such keys never drive.
Where the terminal tells a key's place on the keyboard, that names it: W is the upper of four on every layout.
"""

import codecs
import re
from collections.abc import Callable
from functools import lru_cache
from typing import Literal, NamedTuple

ESCAPE_WAIT = 0.05
"""s until an ESC without a successor is the Escape key."""
LONGEST = 32
"""Bytes of parameters beyond which a sequence is nobody's key."""

ESC, CTRL_C, BEL = 0x1B, 0x03, 0x07
PASTE_END = b"\x1b[201~"
STRINGS = b"P]X^_"  # DCS, OSC, SOS, PM, APC
PLAIN = {0x00: "ctrl-space", 0x08: "backspace", 0x09: "tab", 0x0A: "enter", 0x0D: "enter", 0x7F: "backspace"}
NAMED = {" ": "space", "\x1b": "escape"} | {chr(code): name for code, name in PLAIN.items()}
FINALS = {
    **{"A": "up", "B": "down", "C": "right", "D": "left", "H": "home", "F": "end", "Z": "tab"},
    **{"P": "f1", "Q": "f2", "R": "f3", "S": "f4"},
}
NUMBERED = {
    **{1: "home", 2: "insert", 3: "delete", 4: "end", 5: "pageup", 6: "pagedown", 7: "home", 8: "end"},
    **{11: "f1", 12: "f2", 13: "f3", 14: "f4", 15: "f5", 17: "f6", 18: "f7", 19: "f8", 20: "f9", 21: "f10"},
    **{23: "f11", 24: "f12"},
}
KEYPAD = {57414: "enter", 57417: "left", 57418: "right", 57419: "up", 57420: "down"}
"""Code points that the kitty protocol has made up for what has none."""
SHIFT = 1
MODIFIERS = ((4, "ctrl-"), (2, "alt-"), (8, "super-"), (32, "meta-"))
Event = Literal["press", "repeat", "release"]
EVENTS: dict[int, Event] = {1: "press", 2: "repeat", 3: "release"}


class Key(NamedTuple):
    """What happened to one key; a terminal that tells nothing more calls all of it a press."""

    name: str
    event: Event = "press"
    place: str = ""
    """By which a release is known to be of a press, whatever was held besides at either."""


def names() -> list[str]:
    """Return what keys are called that have no letter of their own."""
    return sorted({*NAMED.values(), *FINALS.values(), *NUMBERED.values(), *KEYPAD.values()})


def is_key(name: str) -> bool:
    """Say whether a key may be called so: by its letter or its name, after what is held with it."""
    for _, prefix in MODIFIERS:
        name = name.removeprefix(prefix)
    return len(name) == 1 or name in names()


class Report(NamedTuple):
    """What a terminal says of itself."""

    of: Literal["attributes", "protocol", "focus"]
    value: int = 0
    """Of the keyboard protocol, its flags; of the focus, whether it is here."""


WHOLE = re.compile(rb"\x1b\[(?!200~)([0-9:;]{0,32})([ABCDFHPQRSu~])")
"""The sequence of a key that came in one piece, as nearly all do; a paste is for the slower way."""


class KeyParser:
    """Feed it bytes cut anywhere; the keys are the same."""

    def __init__(self) -> None:
        self._state: Callable[[int], Key | Report | None] = self._ground
        self._sequence = bytearray()
        self._skip = 0
        self._decoder = codecs.getincrementaldecoder("utf-8")(errors="ignore")
        self._heard = 0.0

    def feed(self, data: bytes, now: float = 0.0) -> list[Key | Report]:
        """Return the keys and reports these bytes complete; a paste is none."""
        if data:
            self._heard = now
        found, at = [], 0
        while at < len(data):
            whole = WHOLE.match(data, at) if self._state == self._ground else None
            if whole:
                self._decoder.reset()
                at, key = whole.end(), whole_key(whole[1], whole[2])
            else:
                at, key = at + 1, self._byte(data[at])
            found += [key] if key else []
        return found

    def flush(self, now: float) -> list[Key | Report]:
        """Return Escape for an ESC nothing followed in time; forget other sequences left unfinished."""
        if self._state in (self._ground, self._paste) or now - self._heard < ESCAPE_WAIT:
            return []
        alone = self._state == self._escape
        self._go(self._ground)
        return [Key("escape")] if alone else []

    def _byte(self, byte: int) -> Key | Report | None:
        if byte == CTRL_C:  # whatever was going on: the way out is never swallowed
            self._go(self._ground)
        return self._state(byte)

    def _go(self, state: Callable[[int], Key | Report | None]) -> None:
        self._state = state
        self._sequence.clear()
        self._decoder.reset()

    def _ground(self, byte: int) -> Key | Report | None:
        if byte == ESC:
            self._go(self._escape)
            return None
        if byte >= 0x20 and byte != 0x7F:
            character = self._decoder.decode(bytes((byte,)))
            return Key(NAMED.get(character, character)) if character else None
        self._decoder.reset()
        return Key(PLAIN.get(byte) or f"ctrl-{chr(byte + 0x40).lower()}")

    def _escape(self, byte: int) -> Key | Report | None:
        if byte == ESC:
            return Key("escape")
        if byte in STRINGS:
            self._go(self._string)
        elif byte in b"[O":
            self._go(self._csi if byte == ord("[") else self._ss3)
        else:
            self._go(self._ground)
            key = self._ground(byte)
            return key._replace(name=f"alt-{key.name}") if isinstance(key, Key) else None
        return None

    def _ss3(self, byte: int) -> Key | Report | None:
        if chr(byte).isdigit():
            return None
        name = FINALS.get(chr(byte))
        return self._end(byte, Key(name) if name else None)

    def _csi(self, byte: int) -> Key | Report | None:
        if 0x20 <= byte <= 0x3F:
            if len(self._sequence) <= LONGEST:
                self._sequence.append(byte)
            return None
        parameters = self._sequence.decode()
        if not parameters and byte == ord("["):
            self._go(self._console)
            return None
        key = self._end(byte, meaning(parameters, chr(byte)))
        if parameters == "200" and byte == ord("~"):
            self._go(self._paste)
        elif not parameters and byte == ord("M"):
            self._go(self._mouse)
            self._skip = 3
        return key

    def _end(self, byte: int, key: Key | Report | None) -> Key | Report | None:
        """Finish a sequence; a byte that cannot end one is a key of its own."""
        self._go(self._ground)
        return key if 0x20 <= byte < 0x7F else self._ground(byte)

    def _console(self, byte: int) -> Key | Report | None:
        """The Linux console says F1 to F5 as ESC [ [ A to E."""
        return self._end(byte, Key(f"f{byte - 0x40}") if byte in b"ABCDE" else None)

    def _mouse(self, byte: int) -> Key | Report | None:
        """A program that died may have left the mouse on: three bytes that look like letters."""
        self._skip -= 1
        if not self._skip:
            self._go(self._ground)
        return None

    def _string(self, byte: int) -> Key | Report | None:
        if byte in (BEL, ESC):
            self._go(self._ground if byte == BEL else self._string_end)
        return None

    def _string_end(self, byte: int) -> Key | Report | None:
        self._go(self._escape)
        return self._end(byte, None) if byte == ord("\\") else self._escape(byte)

    def _paste(self, byte: int) -> Key | Report | None:
        self._sequence.append(byte)
        del self._sequence[: -len(PASTE_END)]
        if self._sequence == PASTE_END:
            self._go(self._ground)
        return None


@lru_cache(1000)
def whole_key(parameters: bytes, final: bytes) -> Key | Report | None:
    """Return the key of a whole sequence; people press the same ones again and again."""
    return meaning(parameters.decode(), final.decode())


def meaning(parameters: str, final: str) -> Key | Report | None:
    """Return what CSI parameters final says; None for what concerns nobody here."""
    if parameters.startswith("?"):
        return {"c": Report("attributes"), "u": protocol(parameters[1:])}.get(final)
    if final in "IO" and not parameters:
        return Report("focus", final == "I")
    try:
        numbers = [[int(part or 1) for part in field.split(":")] for field in parameters.split(";")]
    except ValueError:
        return None
    if len(parameters) > LONGEST or min(parameters, default="0") < "0":
        return None
    modifiers, event = (*(numbers[1] if numbers[1:] else ()), 1, 1)[:2]
    place = place_name(numbers[0]) if final == "u" else NUMBERED.get(numbers[0][0])
    place = place if final in "u~" else FINALS.get(final)
    if place is None or event not in EVENTS:
        return None
    prefix = "".join(prefix for bit, prefix in MODIFIERS if modifiers - 1 & bit)
    name = sign_name(numbers[0]) if final == "u" and modifiers - 1 & SHIFT else None
    return Key(prefix + (name or place), EVENTS[event], place)


def protocol(flags: str) -> Report | None:
    """Return what of the keyboard protocol is on."""
    return Report("protocol", int(flags)) if flags.isdecimal() else None


def place_name(codes: list[int]) -> str | None:
    """Return the key of the kitty protocol's codes: of its place, where that is told, else of its own."""
    code, _, place = (*codes, 1, 1)[:3]  # 1 is none
    return KEYPAD.get(code) or character_name(place if place != 1 else code)


def sign_name(codes: list[int]) -> str | None:
    """Return what shift makes of a key, where that is a sign and no letter."""
    shifted = (*codes, 1)[1]
    return None if shifted == 1 or chr_of(shifted).isalnum() else character_name(shifted)


def character_name(code: int) -> str | None:
    """Return the key of a code point."""
    character = chr_of(code)
    return NAMED.get(character) or (character if character.isprintable() and character else None)


def chr_of(code: int) -> str:
    """Return a character; nothing for what is none."""
    return chr(code) if 0 < code < 0x110000 else ""
