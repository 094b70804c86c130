"""Twists as an operator sees them: what is wanted, what is applied, what a full stick means."""

from zteleop.messages import Twist
from zteleop.screen.dashboard import TABLE, Dashboard, Line, line


def hold_lines(d: Dashboard, columns: int) -> list[Line]:
    turns = d.seen.vehicle is None or not d.seen.vehicle.steers
    applied = d.seen.status.applied if d.seen.status else None
    full = f"{d.speeds.forward:.2f}", f"{d.speeds.turn:.2f}" if turns else "full lock"
    if columns < TABLE:
        full = full[0], full[1].removeprefix("full ")
        wanted = f"{'wanted':<9}{twist_pair(d.seen.twist)}"
        got = f"{'applied':<9}{twist_pair(applied)}"
        return [
            line(1, wanted),
            line(3, got),
            line(4, f"{'speeds':<9}{full[0]:>5} {full[1]:>5}"),
        ]
    turn_keys = "rad/s  i/k" if turns else ""
    return [
        line(8, f"{'':<14}{'forward':<15}turning", "dim"),
        line(1, row("wanted", d.seen.twist)),
        line(3, row("applied", applied)),
        line(4, f"{'full stick':<14}{full[0]:>5} m/s  u/j  {full[1]:>5} {turn_keys}".rstrip()),
    ]


def twist_pair(twist: Twist | None) -> str:
    return f"{twist.linear.x:+.2f} {twist.angular.z:+.2f}" if twist else f"{'-':>5} {'-':>5}"


def row(label: str, twist: Twist | None) -> str:
    if twist is None:
        return f"{label:<14}{'-':>5}{'':<10}{'-':>5}"
    return f"{label:<13}{twist.linear.x:>+6.2f} m/s      {twist.angular.z:>+5.2f} rad/s"
