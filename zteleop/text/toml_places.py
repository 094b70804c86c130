"""Where in a TOML text each of its names stands, for whoever has to correct it."""

import re
from collections.abc import Iterator

_NAME = r"(?:[A-Za-z0-9_-]+|\"[^\"\n]*\"|'[^'\n]*')"
_DOTTED = rf"{_NAME}(?:[ \t]*\.[ \t]*{_NAME})*"
_LINE = re.compile(rf"[ \t]*(?:\[[ \t]*(?P<table>{_DOTTED})[ \t]*\]|(?P<key>{_DOTTED})[ \t]*=)")

Place = tuple[int, int]
"""line and column, from 1"""


def place(text: str, path: tuple[str, ...]) -> Place | None:
    """Return where a path stands, else what it lies in; None where nothing of it is written as a line."""
    places = dict(reversed(list(_places(text))))  # what is written first is it
    for length in range(len(path), 0, -1):
        if found := places.get(path[:length]):
            return found
    return None


def _places(text: str) -> Iterator[tuple[tuple[str, ...], Place]]:
    table: tuple[str, ...] = ()
    for number, line in enumerate(text.splitlines(), 1):
        if match := _LINE.match(line):
            kind = match.lastgroup or ""
            names = tuple(name.strip("\"'") for name in re.findall(_NAME, match[kind]))
            path = names if kind == "table" else (*table, *names)
            table = names if kind == "table" else table
            for length in range(len(path) - len(names) + 1, len(path) + 1):
                yield path[:length], (number, match.start(kind) + 1)
