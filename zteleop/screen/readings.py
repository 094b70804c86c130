"""What an operator is told, from the top line to the keys at the bottom."""

from collections.abc import Iterable
from math import degrees, isfinite

from zteleop.control.proof import called
from zteleop.messages import Twist
from zteleop.screen.dashboard import WIDE, Dashboard, Line, line
from zteleop.screen.hold_lines import hold_lines
from zteleop.screen.step_lines import step_lines, ticks_text
from zteleop.screen.top_view import pose
from zteleop.terminal.cells import Span, cut, printable, width, wrap

COLORS = {"driving": "green", "stopped": "red", "fault": "red"}
STOP, RELEASE = ("backspace", "STOP"), ("r", "release")
KEYS = {
    "step": (("arrows/wasd", "drive"), ("space", "throttle off"), ("x", "neutral"), ("q", "quit")),
    "hold": (
        ("arrows/wasd", "drive while held"),
        ("space", "let go"),
        ("u/j", "speed"),
        ("i/k", "turning"),
        ("q", "quit"),
    ),
}


def readings(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines from the top, best first."""
    drive = step_lines(d, columns) if d.drive == "step" else hold_lines(d, columns)
    return [*heading(d, columns, unicode), *drive, idle(d, columns), line(9), *actuator_lines(d, unicode)]


def footer(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines at the bottom: what the keys do, and the latest of the log."""
    return [*key_lines(d, columns), *note_lines(d, columns, unicode)]


def note_lines(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the note, cut; an alarm is whole, and goes last."""
    note = printable(d.seen.note, unicode)
    if d.seen.alarm:
        return [line(0, text, "red") for text in wrap(note, columns)[:4]]
    note = cut(note, columns)
    return [line(5 if note else 9, note, "dim")]


def brief(d: Dashboard, unicode: bool) -> list[Span]:
    """Return all that matters on a single line."""
    note = Span("  " + printable(d.seen.note, unicode), "red" if d.seen.alarm else "dim")
    return [*state(d, unicode), *([note] if d.seen.alarm else [Span(f"  {values(d)}"), note])]


def heading(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    robot = [Span(printable(d.robot, unicode), "bold"), Span(f"  {d.drive} drive", "dim")]
    word, who = state(d, unicode), operator(d, unicode)
    reason = wrap(why(d, unicode), columns)
    if columns < WIDE:
        rows = [Line(0, word), Line(7, robot), *([line(4, who)] if who else [])]
        rows += [line(2 + i, text) for i, text in enumerate(reason[:5])]
        return rows + slowed(d, columns, unicode)
    word += [Span(f", {who}")] if who else []
    gap = columns - sum(width(span.text) for span in robot + word)
    reasons = [line(2 + i if text else 9, text) for i, text in enumerate(reason)]
    top = [*robot, Span(" " * gap), *word] if gap > 0 else word
    return [Line(0, top), *[*reasons, *slowed(d, columns, unicode), line(9), line(9)][:2]]


def state(d: Dashboard, unicode: bool) -> list[Span]:
    word = d.seen.status.state if d.seen.status else "no actuator"
    return [Span(f"{'●' if unicode else '*'} {word}", COLORS.get(word, "yellow"))]


def operator(d: Dashboard, unicode: bool) -> str:
    if d.seen.status is None:
        return ""
    if not d.seen.status.operator:
        return "nobody operates"
    if d.seen.ours:
        return "you operate"
    return f"{printable(called(d.seen.status.source, d.seen.status.operator), unicode)} operates"


def why(d: Dashboard, unicode: bool) -> str:
    if d.seen.status is None:
        robot = printable(d.robot, unicode)
        start = f"start `zteleop actuator --robot {robot}`"
        return f"no actuator heard on robot {robot}; {start}, or, if it moves, cut its power"
    return printable(d.seen.status.why, unicode)


def slowed(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return why the robot may not go as fast as it can, in a line, while that is so."""
    if d.seen.status is None or not d.seen.status.slowed:
        return []
    words = f"at most {d.seen.status.max_speed:.2f} m/s: {printable(d.seen.status.slowed, unicode)}"
    return [line(7, cut(words, columns), "yellow")]


def values(d: Dashboard) -> str:
    """Return what is asked for now."""
    if d.drive == "step":
        return ticks_text(d)
    twist = d.seen.twist or Twist.planar()
    return f"{twist.linear.x:+.2f} m/s {twist.angular.z:+.2f} rad/s"


def idle(d: Dashboard, columns: int) -> Line:
    label = f"{'idle':<10}" if columns >= 28 else ""
    if d.idle_left is None:
        return line(7, f"{label}at rest", "dim")
    return line(4, f"{label}neutral in {d.idle_left:.1f} s", "yellow" if d.idle_left < 2 else "")


def actuator_lines(d: Dashboard, unicode: bool) -> list[Line]:
    """Return what the actuator tells its chip, and where the robot is."""
    lines = []
    if d.seen.status is not None and d.seen.status.pulses:
        told = ", ".join(f"{printable(p.name, unicode)} {p.duty_ticks}" for p in d.seen.status.pulses[:4])
        lines.append(line(7, f"{'chip':<10}{told}"))
    if d.seen.odom is not None:
        moving = d.seen.odom.twist.twist
        lines.append(line(7, f"{'moving':<10}{moving.linear.x:+.2f} m/s  {moving.angular.z:+.2f} rad/s"))
    if found := pose(d.seen.odom):
        x, y, heading = found
        degree = "°" if unicode else " deg"
        lines.append(line(8, f"{'place':<10}x {x:.2f}  y {y:.2f} m  {degrees(heading):.0f}{degree}"))
    return lines


def steering_angle(d: Dashboard) -> float:
    """Return where the actuator points the front wheels, in rad, positive to the left."""
    pulses = d.seen.status.pulses if d.seen.status else []
    fraction = next((pulse.fraction for pulse in pulses if pulse.name == "steering"), 0.0)
    if d.seen.vehicle is None or not isfinite(fraction):
        return 0.0
    return max(-1.0, min(1.0, fraction)) * d.seen.vehicle.max_steering_angle


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
    return [Line(7 if index else 6, spans) for index, spans in enumerate(lines)]
