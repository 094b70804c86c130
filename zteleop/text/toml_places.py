"""Where in a TOML text each of its names stands, for whoever has to correct it."""

import re
from collections.abc import Iterator, Mapping

_NAME = r"(?:[A-Za-z0-9_-]+|\"[^\"\n]*\"|'[^'\n]*')"
_DOTTED = rf"{_NAME}(?:[ \t]*\.[ \t]*{_NAME})*"
_LINE = re.compile(rf"[ \t]*(?:\[[ \t]*(?P<table>{_DOTTED})[ \t]*\]|(?P<key>{_DOTTED})[ \t]*=)")

Path = tuple[str, ...]
Place = tuple[int, int]
"""line and column, from 1"""


def places(text: str) -> dict[Path, Place]:
    """Return where each name is written first."""
    return dict(reversed(list(_places(text))))


def place(places: Mapping[Path, Place], path: Path) -> Place | None:
    """Return where a path stands, else what it lies in; None where nothing of it is written as a line."""
    prefixes = (path[:length] for length in range(len(path), 0, -1))
    return next((places[prefix] for prefix in prefixes if prefix in places), None)


def _places(text: str) -> Iterator[tuple[Path, Place]]:
    table: Path = ()
    for number, line in enumerate(text.split("\n"), 1):  # whatever else ends a line elsewhere is text in TOML
        if match := _LINE.match(line):
            kind = match.lastgroup or ""
            names = tuple(name.strip("\"'") for name in re.findall(_NAME, match[kind]))
            path = names if kind == "table" else (*table, *names)
            table = names if kind == "table" else table
            for length in range(len(path) - len(names) + 1, len(path) + 1):
                yield path[:length], (number, match.start(kind) + 1)
