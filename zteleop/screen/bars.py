"""Bars: solid is what the chip puts out, hollow is what is asked for besides."""

from math import ceil, isfinite
from typing import NamedTuple

from zteleop.inputs.levers import Axis, Lever
from zteleop.screen.dashboard import LABEL, Dashboard, Line, channel
from zteleop.terminal.cells import Span

CELLS = 8
"""Of each side of a bar whose steps share them; a step of steering has its own."""
WORDS = {"steering": ("left", "right", "straight"), "throttle": ("forward", "reverse", "neutral")}
UNKNOWN = "not known"
COLORS = {"steering": "cyan", "throttle": "green"}
BLOCKS = ("▕", "█", "█", "░", "│", "▏")
PLAIN = {"steering": ("[", "<", ">", ".", "O", "]"), "throttle": ("[", "-", "+", ".", "O", "]")}


class Reach(NamedTuple):
    """How far one axis goes, in cells; positive is right, or forward, as the bar is drawn."""

    asked: int
    out: int
    cells: int
    words: str


def bar_lines(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return how far the operator pushes, and how far the robot follows."""
    axes: tuple[Axis, ...] = ("steering", "throttle")
    return [Line(4, bar_spans(axis, reach(d, axis, columns), unicode)) for axis in axes]


def bar_spans(axis: Axis, found: Reach, unicode: bool) -> list[Span]:
    left, minus, plus, hollow, middle, right = BLOCKS if unicode else PLAIN[axis]
    style = COLORS[axis]
    drawn: list[Span] = []
    for cell in [*range(-found.cells, 0), *range(1, found.cells + 1)]:
        if cell == 1:
            drawn.append(Span(middle))
        if covers(found.out, cell):
            drawn.append(Span(minus if cell < 0 else plus, style))
        else:
            drawn.append(Span(hollow, "dim") if covers(found.asked, cell) else Span(" "))
    return [Span(f"{axis:<{LABEL}}{left}"), *drawn, Span(f"{right}  {found.words}")]


def covers(length: int, cell: int) -> bool:
    """Say whether a bar so long, to the side of its sign, fills a cell."""
    return abs(cell) <= abs(length) and (cell > 0) == (length > 0)


def reach(d: Dashboard, axis: Axis, columns: int) -> Reach:
    room = max(1, (columns - LABEL - 3 - (15 if columns >= 34 else 0)) // 2)
    return in_steps(d, axis, room) if d.drive == "step" else in_parts(d, axis, room)


def in_steps(d: Dashboard, axis: Axis, room: int) -> Reach:
    """Return an axis that is pushed step by step."""
    found = channel(d.seen.vehicle, axis)
    if found is None:
        return Reach(0, 0, min(6, room), "")
    lever = Lever(found, d.steps.of(axis))
    ticks = found.neutral_ticks
    if d.seen.pwm is not None:
        ticks = d.seen.pwm.steering_ticks if axis == "steering" else d.seen.pwm.throttle_ticks
    count, most = lever.count(ticks), max(lever.most(1), lever.most(-1), 1)
    cells = max(1, min(most, room, CELLS if axis == "throttle" else most))
    plus, minus, rest = words_of(d, axis)
    put_out = lever.count(out := out_ticks(d, axis, found.neutral_ticks))
    told = count or put_out  # another one may drive
    off = (ticks if count else out) - found.neutral_ticks
    words = f"{plus if told > 0 else minus} {abs(told)}/{lever.most(told)}" if told else rest
    if told and d.task.unmeasured:  # a servo may be built in upside down
        words = f"{off:+d} ticks"
    elif told and lever.ticks_at(told) != found.neutral_ticks + off:  # another one's, who drives in no steps
        words = f"{plus if told > 0 else minus} {abs(off)} tick{'s'[: abs(off) - 1]}"
    # steering grows to the right for right, which is the negative side of the axis
    sign = -1 if axis == "steering" else 1
    return Reach(sign * share(count / most, cells), sign * share(put_out / most, cells), cells, words)


def in_parts(d: Dashboard, axis: Axis, room: int) -> Reach:
    """Return an axis that is pushed for as long as a key is held, as a part of what the robot can."""
    cells = min(CELLS, room)
    asked, out = asked_part(d, axis), out_part(d, axis)
    plus, minus, rest = words_of(d, axis)
    sign = -1 if axis == "steering" else 1
    told = share(asked, cells) or share(out, cells)
    words = rest if not told else plus if told > 0 else minus
    return Reach(sign * share(asked, cells), sign * share(out, cells), cells, words)


def words_of(d: Dashboard, axis: Axis) -> tuple[str, str, str]:
    """Return what the sides of an axis and its rest are called; nobody knows of rest where nobody tells."""
    plus, minus, rest = WORDS[axis]
    return plus, minus, rest if d.status else UNKNOWN


def asked_part(d: Dashboard, axis: Axis) -> float:
    vehicle, twist = d.seen.vehicle, d.seen.twist
    if vehicle is None or twist is None:
        return 0.0
    if axis == "throttle":
        return part(twist.linear.x, vehicle.max_speed)
    return d.seen.stick.turn if vehicle.steers else part(twist.angular.z, vehicle.max_turn)


def out_part(d: Dashboard, axis: Axis) -> float:
    """Return what an axis does: its pulse, or, where wheels share the work, what they make together."""
    status, vehicle = d.seen.status, d.seen.vehicle
    if status is None or vehicle is None or status.confirmed == "cut":
        return 0.0
    if channel(vehicle, axis):
        return next((pulse.fraction for pulse in d.pulses if pulse.name == axis), 0.0)
    twist = status.applied
    if axis == "throttle":
        return part(twist.linear.x, vehicle.max_speed)
    return part(twist.angular.z, vehicle.max_turn)


def out_ticks(d: Dashboard, axis: Axis, rest: int) -> int:
    return next((pulse.duty_ticks for pulse in d.pulses if pulse.name == axis), rest)


def part(value: float, most: float) -> float:
    return value / most if most > 0 else 0.0


def share(fraction: float, cells: int) -> int:
    """Return a fraction in cells, away from zero: the first step shows, and nothing passes the end."""
    if not isfinite(fraction):
        return 0
    filled = ceil(min(abs(fraction), 1.0) * cells - 1e-9)
    return filled if fraction > 0 else -filled
