"""The newest values of what is measured, and what they come to."""

import argparse
from collections import deque
from collections.abc import Iterator, Sequence
from math import fsum, sqrt
from typing import NamedTuple

MOST = 10_000


class Figures(NamedTuple):
    """Of some values; the deviation is that of these and no others."""

    mean: float
    least: float
    largest: float
    deviation: float
    messages: int


class Window:
    """Keeps the newest `most` values."""

    def __init__(self, most: int = MOST) -> None:
        self.values: deque[float] = deque(maxlen=most)

    def add(self, value: float) -> None:
        self.values.append(value)

    @property
    def figures(self) -> Figures | None:
        """What the values come to; None while there are none."""
        if not self.values:
            return None
        count = len(self.values)
        mean = fsum(self.values) / count
        deviation = sqrt(fsum((value - mean) ** 2 for value in self.values) / count)
        return Figures(mean, min(self.values), max(self.values), deviation, count)


def table(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield rows under the first of them, and an empty line."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    head, *rest = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    yield from (head, "=" * len(head), *rest, "")


def add_argument(parser: argparse.ArgumentParser, default: int = MOST) -> None:
    """Add the option that says how many of the newest messages count."""
    parser.add_argument(
        "-w", "--window", metavar="N", type=_most, default=default, help=f"messages that count ({default})"
    )


def _most(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 1_000_000:
        raise argparse.ArgumentTypeError(f"expected 1 to 1000000 messages, found {text}")
    return int(text)
