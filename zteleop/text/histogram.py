"""Durations as people read them: percentiles in a table, and how often each came as bars."""

from collections.abc import Iterable, Sequence
from math import floor, log10

PERCENTS = (50.0, 90.0, 99.0, 100.0)
HEAD = ("p50", "p90", "p99", "max")
STEPS = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
"""ends of the bars within a power of ten"""
MOST = 14
"""bars"""
BLOCKS = " ▏▎▍▌▋▊▉█"


def percentile(values: Sequence[float], percent: float) -> float:
    """Return the value below which so much of the sorted values lies; of none, 0."""
    if not values:
        return 0.0
    return values[min(len(values) - 1, int(percent / 100 * len(values)))]


def percentiles(values: Iterable[float]) -> tuple[float, ...]:
    """Return the values at PERCENTS."""
    found = sorted(values)
    return tuple(percentile(found, percent) for percent in PERCENTS)


def table(title: str, rows: Iterable[tuple[str, Iterable[float]]], scale: float = 1000.0) -> str:
    """Return a row of percentiles for each name; times in s are shown in ms."""
    told = [(name, [f"{scale * value:.2f}" for value in percentiles(values)]) for name, values in rows]
    width = max((len(name) for name, _ in told), default=0)
    head = f"{title:{width}}" + "".join(f"{name:>9}" for name in HEAD)
    return "\n".join([head, *(f"{name:{width}}" + "".join(f"{v:>9}" for v in cells) for name, cells in told)])


def bars(values: Sequence[float], width: int = 40, scale: float = 1000.0, plain: bool = False) -> str:
    """Return how many values lie below each of some round numbers, as bars, the smallest first."""
    ends = _ends(values)
    counts = [0] * len(ends)
    for value in values:
        counts[next(place for place, end in enumerate(ends) if value <= end or end == ends[-1])] += 1
    most = max(counts, default=0)
    return "\n".join(
        f"{'<= ' + _number(scale * end):>10} {_bar(count, most, width, plain)}{count or ''}"
        for end, count in zip(ends, counts, strict=True)
    )


def _ends(values: Sequence[float]) -> list[float]:
    """Return round numbers from the least to the largest of some values, each the end of a bar."""
    if not values:
        return []
    ends: list[float] = []
    end = _round_up(max(min(values), max(values) / 1e4, 1e-6))
    while not ends or ends[-1] < max(values):
        ends.append(end)
        end = _round_up(end * 1.0001)
    return ends[-MOST:]


def _round_up(value: float) -> float:
    power = 10.0 ** floor(log10(value))
    return next((step * power for step in STEPS if step * power >= value), 10 * power)


def _number(value: float) -> str:
    return f"{value:.3g}"


def _bar(count: int, most: int, width: int, plain: bool) -> str:
    eighths = round(8 * width * count / most) if most else 0
    eighths = max(eighths, 1) if count else 0
    if plain:
        return "#" * -(-eighths // 8) + " " * bool(count)
    return "█" * (eighths // 8) + BLOCKS[eighths % 8].strip() + " " * bool(count)
