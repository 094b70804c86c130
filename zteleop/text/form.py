"""The form in which messages are shown: YAML documents, rows of CSV, lines of JSON."""

from collections.abc import Iterable, Mapping
from typing import Any, Literal

import msgspec

from zteleop.messages import MESSAGES, Message
from zteleop.text.paths import leaves
from zteleop.text.rendering import Style, csv_line, dumper, shorten, to_yaml
from zteleop.text.selection import kind_at

Parts = list[tuple[str, Any]]
Info = Mapping[str, Any]
IN_CSV = (
    "source_timestamp",
    "received_timestamp",
    "publication_sequence_number",
    "reception_sequence_number",
)
"""what ROS puts before a row"""


class Form:
    """Makes text of messages, one after another, not ended by a line's end."""

    def __init__(
        self, name: Literal["yaml", "csv", "json"] = "yaml", style: Style | None = None, header: bool = False
    ) -> None:
        self.kinds: Mapping[str, type[Message]] = MESSAGES
        """the types that are known, which name those of arrays"""
        self._make = {"yaml": self._yaml, "csv": self._csv, "json": self._json}[name]
        self._style = style or Style()
        self._header = header
        self._columns: list[str] = []

    def prepare(self) -> None:
        """Load what takes a while, so that the first message need not wait for it."""
        if self._make == self._yaml:
            dumper()

    def text(self, parts: Iterable[tuple[str, Any]], ros_type: str, info: Info | None = None) -> str:
        """Return what stands for a message, or for those fields of it that have names."""
        shown = [
            (name, shorten(value, self._style, kind_at(ros_type, name, self.kinds))) for name, value in parts
        ]
        return self._make(shown, info)

    def _yaml(self, parts: Parts, info: Info | None) -> str:
        return f"{before(info)}{to_yaml(_whole(parts), self._style.flow)}---"

    def _json(self, parts: Parts, info: Info | None) -> str:
        message = _whole(parts)
        return msgspec.json.encode({"info": info, "message": message} if info else message).decode()

    def _csv(self, parts: Parts, info: Info | None) -> str:
        cells = [(name, info[name]) for name in IN_CSV] if info else []
        cells += [leaf for name, value in parts for leaf in leaves(value, name)]
        row, columns = csv_line(value for _, value in cells), [name or "data" for name, _ in cells]
        if not self._header or columns == self._columns:
            return row
        self._columns = columns  # said again where they change, so that no row is taken for another
        return f"{csv_line(columns)}\n{row}"


def _whole(parts: Parts) -> Any:
    return parts[0][1] if len(parts) == 1 else dict(parts)


def before(info: Info | None) -> str:
    """Return the document about a message that comes before it, if there is one."""
    return f"{to_yaml(dict(info))}---\n" if info else ""
