"""What the keys do, and the latest news."""

from collections.abc import Iterable

from zteleop.screen.dashboard import Dashboard, Line, line
from zteleop.terminal.cells import Span, cut, printable, wrap

STOP, RELEASE, HELP = ("backspace", "STOP"), ("r", "release"), ("?", "keys")
KEYS = {
    "step": (("arrows", "drive"), ("space", "throttle off"), ("x", "neutral"), ("q", "quit"), HELP),
    "hold": (
        ("arrows", "drive"),
        ("space", "let go"),
        ("u/j", "speed"),
        ("i/k", "turning"),
        ("q", "quit"),
        HELP,
    ),
}


def footer(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines at the bottom: what the keys do, and the latest news."""
    return [*key_lines(d, columns), *note_lines(d, columns, unicode)]


def note_lines(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the note, cut; an alarm is whole, and goes last."""
    note = printable(d.seen.note, unicode)
    if d.seen.alarm:
        return [line(0, text, "alarm") for text in wrap(note, columns)[:4]]
    note = cut(note, columns)
    return [line(5 if note else 9, note, "dim")]


def key_lines(d: Dashboard, columns: int) -> list[Line]:
    stopped = d.seen.status is not None and bool(d.seen.status.stops)
    keys: Iterable[tuple[str, str]] = [STOP, *([RELEASE] if stopped else []), *KEYS[d.drive]]
    if d.seen.vehicle is not None and d.seen.vehicle.steers:
        keys = [(key, does) for key, does in keys if key != "i/k"]
    lines: list[list[Span]] = [[]]
    for key, does in keys:
        used = sum(len(span.text) for span in lines[-1])
        if used and used + 3 + len(key) + 1 + len(does) > columns:
            lines.append([])
        style = "bold" if (key, does) == STOP else "dim"
        lines[-1] += [*([Span("   ")] if lines[-1] else []), Span(key, "bold"), Span(f" {does}", style)]
    return [Line(7 if index else 3, spans) for index, spans in enumerate(lines)]
