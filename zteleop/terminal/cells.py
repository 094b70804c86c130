"""Text in the cells of a terminal: what may be shown, how wide it is, where it is cut."""

from typing import NamedTuple
from unicodedata import category, east_asian_width

LONGEST = 1000
"""Characters of one text looked at; no screen is wider."""
STYLES = {
    **{"bold": "1", "dim": "2", "red": "31", "green": "32", "yellow": "33", "cyan": "36"},
    "alarm": "1;97;41",  # bold and white on red
}


class Span(NamedTuple):
    """A piece of a line in one style."""

    text: str
    style: str = ""


def printable(text: str, unicode: bool = True) -> str:
    """Return text with everything escaped that could move the cursor, hide or reorder text."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(c if shown(c, unicode) else escaped(c) for c in text[:LONGEST])


def shown(character: str, unicode: bool) -> bool:
    """Return whether a terminal shows this character as it is."""
    return character.isprintable() and (unicode or character.isascii())


def escaped(character: str) -> str:
    """Return a character as Python would write it."""
    return character.encode("unicode_escape").decode()


def cell_width(character: str) -> int:
    """Return how many cells a character takes: 0 for an accent, 2 for an ideograph."""
    if character.isascii():
        return 1
    return 0 if category(character) in ("Mn", "Me") else 2 if east_asian_width(character) in "WF" else 1


def width(text: str) -> int:
    """Return how many cells a text takes."""
    return len(text) if text.isascii() else sum(map(cell_width, text))


def cut(text: str, cells: int) -> str:
    """Return as much of a text as fits."""
    if len(text) <= cells and text.isascii():
        return text
    used = 0
    for index, character in enumerate(text[:LONGEST]):
        used += cell_width(character)
        if used > cells:
            return text[:index]
    return text[:LONGEST]


def wrap(text: str, cells: int) -> list[str]:
    """Return a text as lines of whole words where words fit."""
    lines: list[str] = []
    line = ""
    for word in text[:LONGEST].split():
        joined = f"{line} {word}" if line else word
        if width(joined) <= cells:
            line = joined
            continue
        lines += [line] if line else []
        while width(word) > cells and (head := cut(word, cells)):
            lines.append(head)
            word = word[len(head) :]
        line = cut(word, cells)
    return [*lines, line] if line else lines


def fit(spans: list[Span], cells: int) -> list[Span]:
    """Return as much of a line as fits."""
    kept: list[Span] = []
    for span in spans:
        text = cut(span.text, cells)
        cells -= width(text)
        kept += [Span(text, span.style)] if text else []
        if text != span.text:
            break
    return kept


def cut_left(spans: list[Span], cells: int) -> list[Span]:
    """Return a line without its first cells; each of its characters takes one."""
    kept: list[Span] = []
    for span in spans:
        text = span.text[cells:]
        cells = max(0, cells - len(span.text))
        kept += [Span(text, span.style)] if text else []
    return kept


def pad(spans: list[Span], cells: int) -> list[Span]:
    """Return a line of exactly so many cells."""
    kept = fit(spans, cells)
    return [*kept, Span(" " * (cells - sum(width(span.text) for span in kept)))]


def paint(spans: list[Span], color: bool) -> str:
    """Return a line for the terminal, with its styles as escape sequences or without any."""
    if not color:
        return "".join(span.text for span in spans).rstrip()
    return "".join(f"\x1b[{STYLES[s.style]}m{s.text}\x1b[0m" if s.style else s.text for s in spans).rstrip()
