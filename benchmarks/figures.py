"""Figures from samples: medians, p99 and tables; and the --quick that every script takes."""

import argparse
import signal
import statistics
import sys
from collections.abc import Sequence

TABLE_GAP = "  "
PYTHON_MS = 10.0
"""what a bare Python takes from start to end where the targets of starts are meant for"""


def command_line(description: str) -> argparse.ArgumentParser:
    """Return what parses the command line of a script, with what every script takes."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="a run of a few seconds: rough figures")
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))  # ends what was started
    return parser


def is_quick(description: str) -> bool:
    """Parse the command line of a script; True for a run of a few seconds."""
    return bool(command_line(description).parse_args().quick)


def p99(samples: Sequence[float]) -> float:
    """Return what 99 of 100 samples stay below; the largest where there are few."""
    return sorted(samples)[min(len(samples) - 1, int(0.99 * len(samples)))]


def median(samples: Sequence[float]) -> float:
    return statistics.median(samples)


def paced(most_ms: float, python_ms: float) -> float:
    """Return a target for how long a start may take, for a machine whose bare Python takes so long."""
    return round(most_ms * max(1.0, python_ms / PYTHON_MS))


def verdict(found: float, most: float, unit: str) -> str:
    """Return a target, and whether it is met."""
    return f"<= {most:g} {unit}: {'met' if found <= most else 'MISSED'}"


def print_table(title: str, head: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Print rows under a head; numbers with three digits that count."""
    cells = [list(head), *([_text(value) for value in row] for row in rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(head))]
    print(f"\n{title}")
    for row in cells:
        print(TABLE_GAP.join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip())


def _text(value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"
