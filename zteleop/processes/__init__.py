"""The programs that a robot is made of. One file per program, one line below."""

from typing import NamedTuple


class Program(NamedTuple):
    """How a program ranks on its machine, and what follows when it dies."""

    started_by: str
    priority: int
    """among real-time threads, where that is permitted; 0 is an ordinary one"""
    oom_score: int
    """-1000 to 1000; the highest goes first when memory is short"""
    death: str


PROGRAMS = {
    "watchdog": Program(
        "zteleop actuator", 20, -900, "the actuator brings neutral and ends; systemd starts both again"
    ),
    "actuator": Program("the watchdog", 10, -800, "the watchdog brings neutral, and starts another"),
    "door": Program("the watchdog", 6, 300, "nobody drives until the watchdog has opened another"),
    "blackbox": Program("the watchdog", 0, 500, "the robot drives on, and the watchdog starts another"),
}
