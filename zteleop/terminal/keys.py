"""Bytes of a terminal to names of keys, one byte at a time.

Shift and the locks leave a key its name; ctrl and alt change it (`ctrl-up`, `alt-w`): such keys never drive.
"""

import codecs
from collections.abc import Callable

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
MODIFIERS = ((4, "ctrl-"), (2, "alt-"))
RELEASE = 3


class KeyParser:
    """Feed it bytes cut anywhere; the keys are the same."""

    def __init__(self) -> None:
        self._state: Callable[[int], str | None] = self._ground
        self._sequence = bytearray()
        self._skip = 0
        self._decoder = codecs.getincrementaldecoder("utf-8")(errors="ignore")
        self._heard = 0.0

    def feed(self, data: bytes, now: float = 0.0) -> list[str]:
        """Return the keys these bytes complete; a paste is none."""
        if data:
            self._heard = now
        return [key for key in map(self._byte, data) if key]

    def flush(self, now: float) -> list[str]:
        """Return Escape for an ESC nothing followed in time; forget other sequences left unfinished."""
        if self._state in (self._ground, self._paste) or now - self._heard < ESCAPE_WAIT:
            return []
        alone = self._state == self._escape
        self._go(self._ground)
        return ["escape"] if alone else []

    def _byte(self, byte: int) -> str | None:
        if byte == CTRL_C:  # whatever was going on: the way out is never swallowed
            self._go(self._ground)
        return self._state(byte)

    def _go(self, state: Callable[[int], str | None]) -> None:
        self._state = state
        self._sequence.clear()
        self._decoder.reset()

    def _ground(self, byte: int) -> str | None:
        if byte == ESC:
            self._go(self._escape)
            return None
        if byte >= 0x20 and byte != 0x7F:
            character = self._decoder.decode(bytes((byte,)))
            return NAMED.get(character, character) or None
        self._decoder.reset()
        return PLAIN.get(byte) or f"ctrl-{chr(byte + 0x40).lower()}"

    def _escape(self, byte: int) -> str | None:
        if byte == ESC:
            return "escape"
        if byte in STRINGS:
            self._go(self._string)
        elif byte in b"[O":
            self._go(self._csi if byte == ord("[") else self._ss3)
        else:
            self._go(self._ground)
            key = self._ground(byte)
            return f"alt-{key}" if key else None
        return None

    def _ss3(self, byte: int) -> str | None:
        if chr(byte).isdigit():
            return None
        return self._end(byte, FINALS.get(chr(byte)))

    def _csi(self, byte: int) -> str | None:
        if 0x20 <= byte <= 0x3F:
            if len(self._sequence) <= LONGEST:
                self._sequence.append(byte)
            return None
        parameters = self._sequence.decode()
        if not parameters and byte == ord("["):
            self._go(self._console)
            return None
        key = self._end(byte, sequence_name(parameters, chr(byte)))
        if parameters == "200" and byte == ord("~"):
            self._go(self._paste)
        elif not parameters and byte == ord("M"):
            self._go(self._mouse)
            self._skip = 3
        return key

    def _end(self, byte: int, key: str | None) -> str | None:
        """Finish a sequence; a byte that cannot end one is a key of its own."""
        self._go(self._ground)
        return key if 0x20 <= byte < 0x7F else self._ground(byte)

    def _console(self, byte: int) -> str | None:
        """The Linux console says F1 to F5 as ESC [ [ A to E."""
        return self._end(byte, f"f{byte - 0x40}" if byte in b"ABCDE" else None)

    def _mouse(self, byte: int) -> str | None:
        """A program that died may have left the mouse on: three bytes that look like letters."""
        self._skip -= 1
        if not self._skip:
            self._go(self._ground)
        return None

    def _string(self, byte: int) -> str | None:
        if byte in (BEL, ESC):
            self._go(self._ground if byte == BEL else self._string_end)
        return None

    def _string_end(self, byte: int) -> str | None:
        self._go(self._escape)
        return self._end(byte, None) if byte == ord("\\") else self._escape(byte)

    def _paste(self, byte: int) -> str | None:
        self._sequence.append(byte)
        del self._sequence[: -len(PASTE_END)]
        if self._sequence == PASTE_END:
            self._go(self._ground)
        return None


def sequence_name(parameters: str, final: str) -> str | None:
    """Return the key that CSI parameters final says; None for a reply, a release or an unknown one."""
    try:
        numbers = [[int(part or 1) for part in field.split(":")] for field in parameters.split(";")]
    except ValueError:
        return None
    if len(parameters) > LONGEST or min(parameters, default="0") < "0":
        return None
    code, (modifiers, event) = numbers[0][0], (*(numbers[1] if numbers[1:] else ()), 1, 1)[:2]
    name = character_name(code) if final == "u" else NUMBERED.get(code) if final == "~" else FINALS.get(final)
    if name is None or event == RELEASE:
        return None
    return "".join(prefix for bit, prefix in MODIFIERS if modifiers - 1 & bit) + name


def character_name(code: int) -> str | None:
    """Return the key of a code point, as the kitty protocol says keys."""
    character = chr(code) if 0 < code < 0x110000 else ""
    return NAMED.get(character) or (character if character.isprintable() and character else None)
