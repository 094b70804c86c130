"""The levers as an operator sees them: the line and the bars of the Donkeycar nodes."""

from zteleop.inputs.levers import Axis, Lever
from zteleop.messages import Channel, Vehicle
from zteleop.screen.dashboard import WIDE, Dashboard, Line, line

THROTTLE_CELLS = 8
"""Of each side of the throttle's bar, whose many steps share them; a step of steering has its own."""
OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
WORDS = {"steering": ("left", "right", "straight"), "throttle": ("forward", "reverse", "neutral")}


def step_lines(d: Dashboard, columns: int) -> list[Line]:
    text = ticks_text(d)
    output = OUTPUT + text if columns >= WIDE else f"{'PWM':<10}{text}" if columns >= 20 else text
    return [
        line(1, output),
        line(9),
        bar_line(d, "steering", columns),
        bar_line(d, "throttle", columns),
    ]


def ticks_text(d: Dashboard) -> str:
    """Return [steering, throttle]; neutral while nobody holds a lever."""
    if d.seen.pwm is not None:
        return f"[{d.seen.pwm.steering_ticks}, {d.seen.pwm.throttle_ticks}]"
    found = [channel(d.seen.vehicle, axis) for axis in ("steering", "throttle")]
    return f"[{', '.join(str(c.neutral_ticks) if c else '-' for c in found)}]"


def bar_line(d: Dashboard, axis: Axis, columns: int) -> Line:
    found = channel(d.seen.vehicle, axis)
    room = (columns - 13 - (15 if columns >= 34 else 0)) // 2
    if found is None:
        return line(3, f"{axis:<10}{bar(0, 1, max(1, min(6, room)), '<>')}")
    lever = Lever(found, d.steps.of(axis))
    ticks = found.neutral_ticks
    if d.seen.pwm is not None:
        ticks = d.seen.pwm.steering_ticks if axis == "steering" else d.seen.pwm.throttle_ticks
    count, most = lever.count(ticks), max(lever.most(1), lever.most(-1), 1)
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


def channel(vehicle: Vehicle | None, name: str) -> Channel | None:
    """Return a vehicle's channel of this name."""
    return next((c for c in vehicle.channels if c.name == name), None) if vehicle else None
