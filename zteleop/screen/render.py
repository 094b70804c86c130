"""What an operator sees, as lines for a terminal of any size."""

from math import isfinite

from zteleop.screen.dashboard import Dashboard, Line
from zteleop.screen.footer import footer
from zteleop.screen.readings import brief, help_lines, readings
from zteleop.screen.top_view import draw
from zteleop.terminal.cells import Span, fit, pad, paint, width

__all__ = ["Dashboard", "render"]

BESIDE = 58
"""Columns from which on the picture stands at the right."""
ROOMY = 80
"""Columns from which on no line of values is as wide as what the lines keep beside it."""
LEAST_COLUMNS, LEAST_ROWS = 16, 6
"""Of a picture worth looking at."""


def render(dashboard: Dashboard, columns: int, rows: int, *, unicode: bool, color: bool) -> list[str]:
    """Return at most `rows` lines, each at most `columns` cells wide."""
    if rows == 1:
        return [paint(cut(brief(dashboard, unicode), columns, unicode), color)]
    whole = readings(dashboard, columns, unicode)
    body, bottom = choose(whole, footer(dashboard, columns, unicode), rows)
    page = [line.spans for line in help_lines(dashboard, columns)] if dashboard.keys else []
    if body and any(spans not in body for spans in page):
        body[-1] = []  # the last of them gives its place to the word of how many there are
        hidden = sum(spans not in body for spans in page)
        body[-1] = [Span(f"and {hidden} more: make the window larger", "dim")]
    spare = rows - len(body) - len(bottom)
    middle = [*body, *[[Span("")]] * spare]
    is_heard = dashboard.seen.odom is not None or dashboard.seen.status is not None
    if is_heard and not dashboard.keys and not dashboard.task.unmeasured:
        middle = with_picture(dashboard, middle, len(body), columns, unicode)
    return [paint(cut(spans, columns, unicode), color) for spans in [*middle, *bottom]]


def cut(spans: list[Span], columns: int, unicode: bool) -> list[Span]:
    """Return as much of a line as fits, with a sign at its end where that is not all."""
    if width("".join(span.text for span in spans).rstrip()) <= columns:
        return fit(spans, columns)
    return [*fit(spans, columns - 1), Span("…" if unicode else "~", "dim")]


def choose(body: list[Line], bottom: list[Line], rows: int) -> tuple[list[list[Span]], list[list[Span]]]:
    """Return the lines there is room for, by rank."""
    lines = [*body, *bottom]
    kept = sorted(range(len(lines)), key=lambda index: (lines[index].rank, index))[: max(0, rows)]
    chosen = [(index, lines[index].spans) for index in sorted(kept)]
    return (
        [spans for index, spans in chosen if index < len(body)],
        [spans for index, spans in chosen if index >= len(body)],
    )


def with_picture(
    d: Dashboard, middle: list[list[Span]], used: int, columns: int, unicode: bool
) -> list[list[Span]]:
    """Return the lines with the robot from above beside or below them, where there is room."""
    beside, left = columns >= BESIDE, 44 if columns >= ROOMY else 36
    wide = [index for index, spans in enumerate(middle) if sum(width(span.text) for span in spans) > left]
    top = max(3, *(index + 1 for index in wide), 0) if beside else used + 1
    rows = len(middle) - top - (1 if beside else 0)
    across = columns - left - 2 if beside else columns
    if rows < LEAST_ROWS or across < LEAST_COLUMNS:
        return middle
    picture = draw(d.seen.odom, d.trail, steering_angle(d), d.seen.vehicle, across, rows, unicode, d.floor)
    margin = left + 2 if beside else 0
    shown = [[*pad(middle[top + i], margin), *spans] for i, spans in enumerate(picture)]
    return [*middle[:top], *shown, *middle[top + rows :]]


def steering_angle(d: Dashboard) -> float:
    """Return where the actuator points the front wheels, in rad, positive to the left."""
    pulses = d.seen.status.pulses if d.seen.status else []
    fraction = next((pulse.fraction for pulse in pulses if pulse.name == "steering"), 0.0)
    if d.seen.vehicle is None or not isfinite(fraction):
        return 0.0
    return max(-1.0, min(1.0, fraction)) * d.seen.vehicle.max_steering_angle
