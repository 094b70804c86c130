"""Pictures taken apart: their dots, and where these are."""

from collections.abc import Iterable
from math import atan2

BITS = {
    **{0x01: (0, 0), 0x02: (0, 1), 0x04: (0, 2), 0x40: (0, 3)},
    **{0x08: (1, 0), 0x10: (1, 1), 0x20: (1, 2), 0x80: (1, 3)},
}
Dots = set[tuple[int, int]]


def dots(lines: Iterable[str]) -> Dots:
    """The dots of a braille picture: x to the right, y down."""
    return {
        (2 * column + dx, 4 * row + dy)
        for row, line in enumerate(lines)
        for column, character in enumerate(line)
        if 0x2800 <= ord(character) < 0x2900
        for bit, (dx, dy) in BITS.items()
        if (ord(character) - 0x2800) & bit
    }


def middle(places: Dots) -> tuple[float, float]:
    return sum(x for x, _ in places) / len(places), sum(y for _, y in places) / len(places)


def lean(places: Dots) -> float:
    """The direction of the long side of a cloud of dots, in rad from straight up, positive to the left."""
    mx, my = middle(places)
    xx = sum((x - mx) ** 2 for x, _ in places)
    yy = sum((y - my) ** 2 for _, y in places)
    xy = sum((x - mx) * (y - my) for x, y in places)
    return atan2(2 * xy, yy - xx) / 2
