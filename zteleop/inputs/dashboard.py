"""What an operator is told, as lines that know their rank: in a small window the last ranks go first."""

from collections.abc import Iterable, Sequence
from math import degrees, isfinite
from typing import Literal, NamedTuple

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs.cells import Span, cut, printable, width, wrap
from zteleop.inputs.levers import Axis, Lever, Steps
from zteleop.inputs.top_view import pose
from zteleop.messages import Channel, DriveStatus, Odometry, Pwm, Twist, Vehicle

WIDE = 62
"""Columns from which on the lines are laid out as the Donkeycar nodes did."""
TABLE = 44
"""Columns that a table of two columns takes."""
THROTTLE_CELLS = 8
"""Of each side of the throttle's bar, whose many steps share them; a step of steering has its own."""
OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
COLORS = {"driving": "green", "stopped": "red", "fault": "red"}
WORDS = {"steering": ("left", "right", "straight"), "throttle": ("forward", "reverse", "neutral")}
KEYS = {
    "step": (("arrows/wasd", "drive"), ("space", "stop"), ("x", "neutral"), ("q", "quit")),
    "hold": (
        ("arrows/wasd", "drive while held"),
        ("space", "let go"),
        ("u/j", "speed"),
        ("i/k", "turning"),
        ("q", "quit"),
    ),
}


class Dashboard(NamedTuple):
    """Everything shown; what was not heard is None."""

    robot: str
    drive: Literal["step", "hold"]
    speeds: Speeds
    vehicle: Vehicle | None = None
    stick: Stick = Stick()
    pwm: Pwm | None = None
    """The ticks wanted now; None is neutral."""
    twist: Twist | None = None
    """The twist wanted now; None is rest."""
    status: DriveStatus | None = None
    ours: bool = False
    """We are the operator obeyed."""
    odom: Odometry | None = None
    trail: Sequence[tuple[float, float]] = ()
    idle_left: float | None = None
    """s until neutral for want of a key."""
    note: str = ""
    steps: Steps = Steps()


class Line(NamedTuple):
    """One line and its rank; 0 goes last."""

    rank: int
    spans: list[Span]


def line(rank: int, text: str = "", style: str = "") -> Line:
    """Return a line in one style."""
    return Line(rank, [Span(text, style)])


def readings(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines from the top, best first."""
    drive = step_lines(d, columns) if d.drive == "step" else hold_lines(d, columns)
    return [*heading(d, columns, unicode), *drive, line(9), *actuator_lines(d, unicode)]


def footer(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines at the bottom: what the keys do, and the latest of the log."""
    note = cut(printable(d.note, unicode), columns)
    return [*key_lines(d, columns), line(5 if note else 9, note, "dim")]


def brief(d: Dashboard, unicode: bool) -> list[Span]:
    """Return all that matters on a single line."""
    return [*state(d, unicode), Span(f"  {values(d)}"), Span("  " + printable(d.note, unicode), "dim")]


def heading(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    robot = [Span(printable(d.robot, unicode), "bold"), Span(f"  {d.drive} drive", "dim")]
    word, who = state(d, unicode), operator(d, unicode)
    reason = wrap(why(d, unicode), columns)
    if columns < WIDE:
        rows = [Line(0, word), Line(7, robot), *([line(4, who)] if who else [])]
        return [*rows, *(line(2 + i, text) for i, text in enumerate(reason[:5]))]
    word += [Span(f", {who}")] if who else []
    gap = columns - sum(width(span.text) for span in robot + word)
    reason = [*reason, "", ""][:2]
    top = [*robot, Span(" " * gap), *word] if gap > 0 else word
    return [Line(0, top), *(line(2 + i if text else 9, text) for i, text in enumerate(reason))]


def state(d: Dashboard, unicode: bool) -> list[Span]:
    word = d.status.state if d.status else "no actuator"
    return [Span(f"{'●' if unicode else '*'} {word}", COLORS.get(word, "yellow"))]


def operator(d: Dashboard, unicode: bool) -> str:
    if d.status is None:
        return ""
    if not d.status.operator:
        return "nobody operates"
    return (
        "you operate"
        if d.ours
        else f"{printable(f'{d.status.source} {d.status.operator[:4]}', unicode)} operates"
    )


def why(d: Dashboard, unicode: bool) -> str:
    if d.status is None:
        robot = printable(d.robot, unicode)
        return f"nobody moves: no actuator heard on robot {robot}; start `zteleop actuator`"
    return printable(d.status.why, unicode)


def values(d: Dashboard) -> str:
    """Return what is asked for now."""
    if d.drive == "step":
        return ticks_text(d)
    twist = d.twist or Twist.planar()
    return f"{twist.linear.x:+.2f} m/s {twist.angular.z:+.2f} rad/s"


def step_lines(d: Dashboard, columns: int) -> list[Line]:
    text = ticks_text(d)
    output = OUTPUT + text if columns >= WIDE else f"{'PWM':<10}{text}" if columns >= 20 else text
    return [
        line(1, output),
        line(9),
        bar_line(d, "steering", columns),
        bar_line(d, "throttle", columns),
        idle(d, columns),
    ]


def ticks_text(d: Dashboard) -> str:
    """Return [steering, throttle]; neutral while nobody holds a lever."""
    if d.pwm is not None:
        return f"[{d.pwm.steering_ticks}, {d.pwm.throttle_ticks}]"
    found = [channel(d.vehicle, axis) for axis in ("steering", "throttle")]
    return f"[{', '.join(str(c.neutral_ticks) if c else '-' for c in found)}]"


def channel(vehicle: Vehicle | None, name: str) -> Channel | None:
    """Return a vehicle's channel of this name."""
    return next((c for c in vehicle.channels if c.name == name), None) if vehicle else None


def bar_line(d: Dashboard, axis: Axis, columns: int) -> Line:
    found = channel(d.vehicle, axis)
    if found is None:
        return line(3, f"{axis:<10}[{'O':^13}]")
    lever = Lever(found, d.steps.of(axis))
    ticks = found.neutral_ticks
    if d.pwm is not None:
        ticks = d.pwm.steering_ticks if axis == "steering" else d.pwm.throttle_ticks
    count, most = lever.count(ticks), max(lever.most(1), lever.most(-1), 1)
    room = (columns - 13 - (16 if columns >= TABLE else 0)) // 2
    cells = max(1, min(most, room, THROTTLE_CELLS if axis == "throttle" else most))
    # steering grows to the right for right, which is the negative side of the axis
    drawn = bar(-count, most, cells, "<>") if axis == "steering" else bar(count, most, cells, "-+")
    plus, minus, rest = WORDS[axis]
    words = f"{plus if count > 0 else minus} {abs(count)}/{lever.most(count)}" if count else rest
    return line(3, f"{axis:<10}{drawn}  {words}")


def bar(count: int, most: int, cells: int, marks: str) -> str:
    """Return `[   O>>>]`: a mark a step, or a share of them where there are more steps than cells."""
    filled = min(cells, -(-abs(count) * cells // most))
    left, right = (filled, 0) if count < 0 else (0, filled)
    return f"[{(marks[0] * left).rjust(cells)}O{(marks[1] * right).ljust(cells)}]"


def hold_lines(d: Dashboard, columns: int) -> list[Line]:
    turns = d.vehicle is None or d.vehicle.kind != "ackermann"
    applied = d.status.applied if d.status else None
    full = f"{d.speeds.forward:.2f}", f"{d.speeds.turn:.2f}" if turns else "full lock"
    if columns < TABLE:
        full = full[0], full[1].removeprefix("full ")
        wanted = f"{'wanted':<9}{twist_pair(d.twist)}"
        got = f"{'applied':<9}{twist_pair(applied)}"
        return [
            line(1, wanted),
            line(3, got),
            line(4, f"{'speeds':<9}{full[0]:>5} {full[1]:>5}"),
            idle(d, columns),
        ]
    turn_keys = "rad/s  i/k" if turns else ""
    return [
        line(8, f"{'':<14}{'forward':<15}turning", "dim"),
        line(1, row("wanted", d.twist)),
        line(3, row("applied", applied)),
        line(4, f"{'full stick':<14}{full[0]:>5} m/s  u/j  {full[1]:>5} {turn_keys}".rstrip()),
        idle(d, columns),
    ]


def twist_pair(twist: Twist | None) -> str:
    return f"{twist.linear.x:+.2f} {twist.angular.z:+.2f}" if twist else f"{'-':>5} {'-':>5}"


def row(label: str, twist: Twist | None) -> str:
    if twist is None:
        return f"{label:<14}{'-':>5}{'':<10}{'-':>5}"
    return f"{label:<13}{twist.linear.x:>+6.2f} m/s      {twist.angular.z:>+5.2f} rad/s"


def idle(d: Dashboard, columns: int) -> Line:
    label = f"{'idle':<10}" if columns >= 28 else ""
    if d.idle_left is None:
        return line(7, f"{label}at rest", "dim")
    return line(4, f"{label}neutral in {d.idle_left:.1f} s", "yellow" if d.idle_left < 2 else "")


def actuator_lines(d: Dashboard, unicode: bool) -> list[Line]:
    """Return what the actuator tells its chip, and where the robot is."""
    lines = []
    if d.status is not None and d.status.pulses:
        told = ", ".join(f"{printable(p.name, unicode)} {p.duty_ticks}" for p in d.status.pulses[:4])
        lines.append(line(6, f"{'chip':<10}{told}"))
    if d.odom is not None:
        moving = d.odom.twist.twist
        lines.append(line(6, f"{'moving':<10}{moving.linear.x:+.2f} m/s  {moving.angular.z:+.2f} rad/s"))
    if found := pose(d.odom):
        x, y, heading = found
        degree = "°" if unicode else " deg"
        lines.append(line(7, f"{'place':<10}x {x:.2f}  y {y:.2f} m  {degrees(heading):.0f}{degree}"))
    return lines


def steering_angle(d: Dashboard) -> float:
    """Return where the actuator points the front wheels, in rad, positive to the left."""
    pulses = d.status.pulses if d.status else []
    fraction = next((pulse.fraction for pulse in pulses if pulse.name == "steering"), 0.0)
    if d.vehicle is None or not isfinite(fraction):
        return 0.0
    return max(-1.0, min(1.0, fraction)) * d.vehicle.max_steering_angle


def key_lines(d: Dashboard, columns: int) -> list[Line]:
    keys: Iterable[tuple[str, str]] = KEYS[d.drive]
    if d.vehicle is not None and d.vehicle.kind == "ackermann":
        keys = [(key, does) for key, does in keys if key != "i/k"]
    lines: list[list[Span]] = [[]]
    for key, does in keys:
        used = sum(len(span.text) for span in lines[-1])
        if used and used + 3 + len(key) + 1 + len(does) > columns:
            lines.append([])
        lines[-1] += [*([Span("   ")] if lines[-1] else []), Span(key, "bold"), Span(f" {does}", "dim")]
    return [Line(7 if index else 6, spans) for index, spans in enumerate(lines)]
