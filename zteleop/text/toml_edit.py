"""Change values of a TOML text and leave everything else of it as somebody wrote it.

Needs the extra [calibrate]; whoever calls without it sees ModuleNotFoundError.
"""

import re
from collections.abc import Mapping
from typing import Any

import tomlkit
from tomlkit.items import Item

Path = tuple[str, ...]
"""Names of tables, then of the value."""


def edited(text: str, values: Mapping[Path, Any], told: Mapping[Path, tuple[int, int]] | None = None) -> str:
    """Return the text with these values; tables that are not there yet stand at its end.

    A comment on a value's line stays. Where it tells the number before, it tells the one after: `told` has
    both for each value. Raises ValueError for a text that is no TOML.
    """
    document = tomlkit.parse(text)
    for path, value in values.items():
        table: Any = document
        for name in path[:-1]:
            if name not in table:
                table.add(name, tomlkit.table(is_super_table=True))
            table = table[name]
        before = table.get(path[-1])
        table[path[-1]] = value
        if isinstance(before, Item) and told and path in told:
            _tell(table[path[-1]], *told[path])
    return tomlkit.dumps(document)


def _tell(item: Item, before: int, after: int) -> None:
    """Put one number for another in the comment behind a value."""
    item.trivia.comment = re.sub(rf"(?<![\d.]){before}(?![\d.])", str(after), item.trivia.comment)
