"""A picture of dots in the cells of a terminal."""

from collections.abc import Sequence
from itertools import groupby, pairwise

from zteleop.terminal.cells import Span

Dot = tuple[float, float]
BRAILLE = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))


class Canvas:
    """Dots, two by four to a cell; without braille every line leaves the character nearest its slope.

    A cell has the style of the last dot set in it.
    """

    def __init__(self, columns: int, rows: int, unicode: bool) -> None:
        self.columns = columns
        self.rows = rows
        self.unicode = unicode
        self._bits = [[0] * columns for _ in range(rows)]
        self._marks = [[" "] * columns for _ in range(rows)]
        self._styles = [[""] * columns for _ in range(rows)]

    def dot(self, x: float, y: float, mark: str = ".", style: str = "") -> None:
        """Set one dot, x to the right and y down; outside nothing happens."""
        column, row = int(x // 2), int(y // 4)
        if 0 <= column < self.columns and 0 <= row < self.rows:
            self._bits[row][column] |= BRAILLE[int(y) % 4][int(x) % 2]
            self._marks[row][column] = mark
            self._styles[row][column] = style

    def line(self, start: Dot, end: Dot, mark: str = "", style: str = "") -> None:
        """Set the dots from one place to another, as far as they lie in the picture."""
        seen = clip(start, end, 2 * self.columns, 4 * self.rows)
        if seen is None:
            return
        start, end = seen
        (x, y), (right, down) = start, (end[0] - start[0], end[1] - start[1])
        steps = max(1, round(max(abs(right), abs(down))))
        for step in range(steps + 1):
            part = step / steps
            self.dot(x + part * right, y + part * down, mark or slope(right, down), style)

    def polygon(self, corners: Sequence[Dot], mark: str, style: str = "") -> None:
        """Set the dots inside a convex outline; the mark " " clears them."""
        heights = [y for _, y in corners]
        edges = [*pairwise(corners), (corners[-1], corners[0])]
        for row in range(round(min(heights)), round(max(heights))):
            y = row + 0.5
            across = [
                x0 + (x1 - x0) * (y - y0) / (y1 - y0)
                for (x0, y0), (x1, y1) in edges
                if (y0 <= y) != (y1 <= y)
            ]
            for x in range(round(min(across)), round(max(across))) if across else ():
                if mark == " ":
                    self._clear(x, row)
                else:
                    self.dot(x, row, mark, style)

    def _clear(self, x: int, y: int) -> None:
        column, row = x // 2, y // 4
        if 0 <= column < self.columns and 0 <= row < self.rows:
            self._bits[row][column] &= ~BRAILLE[y % 4][x % 2]
            self._marks[row][column] = " "

    def lines(self) -> list[list[Span]]:
        """Return the picture, every line of full width."""
        return [self._spans(row) for row in range(self.rows)]

    def _spans(self, row: int) -> list[Span]:
        cells = [
            (character, style if character != " " else "")
            for character, style in zip(self._characters(row), self._styles[row], strict=True)
        ]
        runs = groupby(cells, key=lambda cell: cell[1])
        return [Span("".join(character for character, _ in run), style) for style, run in runs]

    def _characters(self, row: int) -> list[str]:
        if not self.unicode:
            return self._marks[row]
        return [chr(0x2800 + bits) if bits else " " for bits in self._bits[row]]


def slope(right: float, down: float) -> str:
    """Return the character that looks most like a line, where a cell is twice as high as wide."""
    if abs(right) < abs(down) / 4:
        return "|"
    if abs(down) < abs(right) / 2:
        return "-"
    return "\\" if right * down > 0 else "/"


def clip(start: Dot, end: Dot, across: float, down: float) -> tuple[Dot, Dot] | None:
    """Return the part of a line that lies from 0, 0 to `across`, `down`; None where none does.

    Y. Liang and B. Barsky, A New Concept and Method for Line Clipping, 1984.
    """
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    first, last = 0.0, 1.0
    for way, room in ((-dx, x), (dx, across - x), (-dy, y), (dy, down - y)):
        if way == 0:
            if room < 0:
                return None
        elif way < 0:
            first = max(first, room / way)
        else:
            last = min(last, room / way)
    if first > last:
        return None
    return (x + first * dx, y + first * dy), (x + last * dx, y + last * dy)
