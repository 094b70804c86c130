"""From key to wheel in four lines: what is asked for, what is allowed, what the chip puts out, what moves."""

from math import degrees

from zteleop.messages import Twist
from zteleop.screen.dashboard import Dashboard, Line, channel, labelled, line
from zteleop.screen.top_view import pose
from zteleop.terminal.cells import printable

OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
SHORT = 34
"""Columns below which numbers stand without units and names."""


def value_lines(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the way of a command, from the operator to the ground."""
    allowed = d.status.applied if d.status else None
    out = labelled(1, "out", out_text(d, columns, unicode), columns)
    if d.task.unmeasured:
        return [out]
    lines = [asked_line(d, columns), labelled(5, "allowed", twist_text(allowed, columns), columns), out]
    if d.seen.odom is not None:
        lines.append(labelled(7, "moving", twist_text(d.seen.odom.twist.twist, columns), columns))
    if d.seen.odom_lost:
        lines.append(labelled(7, "moving", "its place is not told any more", columns, "yellow"))
    if found := pose(d.seen.odom):
        x, y, heading = found
        degree = "°" if unicode else " deg"
        lines.append(labelled(8, "place", f"x {x:.2f}  y {y:.2f} m  {degrees(heading):.0f}{degree}", columns))
    return lines


def asked_line(d: Dashboard, columns: int) -> Line:
    """Return what the operator asks for; dim where it is rest, or nobody obeys."""
    text = asked_text(d, columns)
    if d.asks and not d.obeyed:
        text += "  not obeyed" if columns >= SHORT else " no"
    return labelled(2, "asked", text, columns, "" if d.asks and d.obeyed else "dim")


def asked_text(d: Dashboard, columns: int) -> str:
    if d.drive == "hold":
        return twist_text(d.seen.twist or Twist.planar(), columns)
    if d.seen.pwm is not None:
        return f"[{d.seen.pwm.steering_ticks}, {d.seen.pwm.throttle_ticks}]"
    found = [channel(d.seen.vehicle, axis) for axis in ("steering", "throttle")]
    return f"[{', '.join(str(c.neutral_ticks) if c else '-' for c in found)}]"


def out_text(d: Dashboard, columns: int, unicode: bool) -> str:
    """Return what the chip took last; no pulse where its outputs are cut."""
    status = d.status
    if status is None:
        return "-"
    if status.confirmed == "cut":
        return "no pulse: its outputs are cut" if columns >= 40 else "no pulse"
    if d.drive == "step" and columns < SHORT:
        return output_ticks(d)
    if columns < SHORT:
        return " ".join(str(pulse.duty_ticks) for pulse in status.pulses[:4])
    return ", ".join(f"{printable(p.name, unicode)} {p.duty_ticks}" for p in status.pulses[:4]) or "-"


def output_line(d: Dashboard) -> Line:
    """Return the line of the Donkeycar nodes, with what the chip took last."""
    return line(1, OUTPUT + output_ticks(d))


def output_ticks(d: Dashboard) -> str:
    """Return [steering, throttle] as the chip puts them out."""
    ticks = {pulse.name: str(pulse.duty_ticks) for pulse in d.pulses}
    return f"[{ticks.get('steering', '-')}, {ticks.get('throttle', '-')}]"


def speeds_line(d: Dashboard, columns: int) -> Line:
    """Return what a full stick means, and the keys that change it."""
    vehicle, forward, turning = d.seen.vehicle, d.speeds.forward, d.speeds.turn
    if vehicle:  # whatever is wished for, a full stick means no more than the robot can
        forward, turning = min(forward, vehicle.max_speed), min(turning, vehicle.max_turn)
    turns = vehicle is None or not vehicle.steers
    if columns < SHORT:
        turn = f"{turning:5.2f}" if turns else "lock"
        return labelled(4, "speeds", f"{forward:5.2f} {turn}", columns)
    turn = f"{turning:.2f} rad/s{keys(d, 'turn faster', 'turn slower')}" if turns else "full lock"
    return labelled(4, "full", f"{forward:.2f} m/s{keys(d, 'faster', 'slower')}  {turn}", columns)


def keys(d: Dashboard, *actions: str) -> str:
    """Return the keys of two actions that belong together, where both are bound."""
    bound = [d.bound[action] for action in actions if action in d.bound]
    return " " + "/".join(bound) if len(bound) == len(actions) else ""


def twist_text(twist: Twist | None, columns: int) -> str:
    """Return how fast it goes forward and turns."""
    if twist is None:
        return "-"
    if columns < SHORT:
        return f"{twist.linear.x:+.2f} {twist.angular.z:+.2f}"
    return f"{twist.linear.x:+.2f} m/s  {twist.angular.z:+.2f} rad/s"
