"""Runs of values of fixed size: one `struct` format each, or eight where one may begin anywhere.

Each value is aligned to its own size, counted from the first byte after the header (section 7.4.1.1).
"""

import struct
from typing import NamedTuple

CODES = {
    "bool": "?",
    "byte": "B",
    "char": "B",
    "float32": "f",
    "float64": "d",
    "int8": "b",
    "int16": "h",
    "int32": "i",
    "int64": "q",
    "uint8": "B",
    "uint16": "H",
    "uint32": "I",
    "uint64": "Q",
}
"""by ROS's name of a plain type: that of Python's `struct`"""
WORD = 8
"""bytes after which alignments repeat"""


class Part(NamedTuple):
    """Values of one size, side by side."""

    code: str
    number: int
    """how many; of "s", bytes of the one value"""

    @property
    def size(self) -> int:
        return struct.calcsize(f"<{self.code}")


class Run(NamedTuple):
    """A run that begins at some place after an alignment."""

    packed: struct.Struct
    phase: int
    """where it ends, in bytes after an alignment"""


def run(parts: list[Part], phase: int, order: str, before: str = "") -> Run:
    """Return the format of parts that begin `phase` bytes after an alignment, behind that of a header."""
    place, text = phase, order + before
    for part in parts:
        padding = -place % part.size
        text += "x" * padding + f"{part.number}{part.code}"
        place += padding + part.size * part.number
    return Run(struct.Struct(text), place % WORD)


def runs(parts: list[Part], order: str) -> list[Run]:
    """Return the format for each place at which parts may begin."""
    return [run(parts, phase, order) for phase in range(WORD)]


def end_of(parts: list[Part], phase: int | None) -> int | None:
    """Return where parts end, in bytes after an alignment; None where that depends on the message."""
    if phase is not None:
        return run(parts, phase, "<").phase
    ends = {found.phase for found in runs(parts, "<")}
    return ends.pop() if len(ends) == 1 else None
