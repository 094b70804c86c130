"""The text of a function that is made for a type of message, and the values it needs."""

from typing import Any


class Source:
    """Lines of Python, and what stands behind the names in them."""

    def __init__(self, first: str) -> None:
        self._lines = [first]
        self._names: dict[str, Any] = {}
        self._depth = 1
        self._count = 0

    def line(self, text: str) -> None:
        self._lines.append("    " * self._depth + text)

    def indent(self, by: int) -> None:
        """Go on within what the line before begins, or after it."""
        self._depth += by

    def name(self, start: str) -> str:
        """Return a name that is not taken."""
        self._count += 1
        return f"{start}{self._count}"

    def hold(self, start: str, value: Any) -> str:
        """Return the name by which a value is known."""
        name = self.name(start)
        self._names[name] = value
        return name

    def function(self, name: str, file: str) -> Any:
        """Return the function of that name; `file` is told where it fails."""
        space = dict(self._names)
        exec(compile("\n".join(self._lines) + "\n", file, "exec"), space)
        return space[name]
