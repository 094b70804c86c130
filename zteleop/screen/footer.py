"""What the keys do, and the latest news."""

from zteleop.screen.dashboard import Dashboard, Line, line
from zteleop.terminal.cells import Span, printable, wrap

STOP = "STOP"
ARROWS = ["up", "left", "down", "right"]


def footer(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines at the bottom: what the keys do, and the latest news."""
    return [*key_lines(d, columns), *note_lines(d, columns, unicode)]


def note_lines(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the note, in two lines at most; an alarm is whole, and goes last."""
    note = printable(d.seen.note, unicode)
    if d.seen.alarm:
        return [line(0, text, "alarm") for text in wrap(note, columns)[:4]]
    lines = wrap(note, columns)[:2] or [""]
    return [line((5 if text else 9) + index, text, "dim") for index, text in enumerate(lines)]


def key_lines(d: Dashboard, columns: int) -> list[Line]:
    lines: list[list[Span]] = [[]]
    for key, does in hints(d):
        used = sum(len(span.text) for span in lines[-1])
        if used and used + 3 + len(key) + 1 + len(does) > columns:
            lines.append([])
        style = "bold" if does == STOP else "dim"
        lines[-1] += [*([Span("   ")] if lines[-1] else []), Span(key, "bold"), Span(f" {does}", style)]
    first = 2 if d.keys else 3  # where each key is shown, the one that stops goes last
    return [Line(7 if index else first, spans) for index, spans in enumerate(lines)]


def hints(d: Dashboard) -> list[tuple[str, str]]:
    """Return the keys that matter, the most urgent first, and what they do."""
    status, vehicle = d.seen.status, d.seen.vehicle
    directions = [d.bound[action] for action in ("forward", "left", "reverse", "right") if action in d.bound]
    rest = "stop" if "stop" in d.bound else "neutral"
    step, turns = d.drive == "step", not (vehicle and vehicle.steers)
    wanted = [
        (True, ("stop robot",), STOP),
        (bool(status and status.stops), ("release robot",), "release"),
        (bool(directions), (), "drive"),
        (step, ("stop",), "throttle off"),
        (step, ("neutral",), "neutral"),
        (not step, (rest,), "let go"),
        (not step, ("faster", "slower"), "speed"),
        (not step and turns, ("turn faster", "turn slower"), "turning"),
        (True, ("quit",), "quit"),
        (True, ("help",), "keys"),
    ]
    return [
        ("/".join(d.bound[action] for action in actions) if actions else named(directions), does)
        for is_so, actions, does in wanted
        if is_so and d.bound.keys() >= {*actions}
    ]


def named(directions: list[str]) -> str:
    """Return four keys in a word."""
    if directions == ARROWS:
        return "arrows"
    return ("/" if any(len(key) > 1 for key in directions) else "").join(directions)
