"""A link that is late costs speed, between real processes, measured at the chip from outside."""

from collections.abc import Iterator
from contextlib import contextmanager

from rig import NEUTRAL, Process, Rig, Watch, hear, until
from verdict import excusable

from zteleop.chaos.cable import Cable
from zteleop.messages import DriveStatus

FULL = "{linear: {x: 3.0}}"
FULL_TICKS = 500
LATE = 0.09
"""s each way: a command is then 0.18 s old, and as much older as its beat was when it was made."""


@contextmanager
def late_link(port: int) -> Iterator[int]:
    """Lend a port that leads to another one, late."""
    with Cable(port) as cable:
        cable.delay = LATE
        yield cable.port


def drive(rig: Rig, port: int | None = None) -> Process:
    """Ask for full speed, 50 times a second, from a process of its own."""
    return rig.join("pub", "cmd_vel/keyboard", "Twist", FULL, "-r", "50", port=port)


def settled(status: DriveStatus) -> bool:
    return status.state == "driving" and status.applied.linear.x > status.max_speed - 0.05


def test_a_good_link_is_not_slowed_down(rig: Rig) -> None:
    rig.actuator()
    statuses = rig.node().subscription("drive_status", DriveStatus)
    with excusable(0.05, rig):
        drive(rig)
        until(lambda: rig.ticks == (NEUTRAL[0], FULL_TICKS), "full throttle")
        said = hear(statuses, settled, "full speed")
        assert (said.max_speed, said.slowed) == (3.0, "")
        assert 0 < said.latency < 0.15
    assert "m/s: commands of keyboard are up to" in rig.result("why", *rig.bus_options()).stdout


def test_a_late_link_is_driven_slower_and_says_why(rig: Rig) -> None:
    rig.actuator()
    statuses = rig.node().subscription("drive_status", DriveStatus)
    with late_link(rig.port) as port, Watch(rig) as watch:
        with excusable(0.05, rig):
            program = drive(rig, port)
            said = hear(statuses, settled, "as fast as it may")
            assert 1.5 <= said.max_speed < 2.85
            assert 2 * LATE < said.latency <= 0.3
        assert said.slowed.startswith("commands of keyboard are up to ")
        why = rig.result("why", *rig.bus_options()).stdout
        assert " of 3 m/s: commands of keyboard are up to " in why
        assert "it must stop as soon as on a good link" in why
        program.close()
        until(lambda: rig.ticks == NEUTRAL, "neutral")
    fastest = max(throttle or 0 for _, throttle in watch.seen)
    assert NEUTRAL[1] + 60 < fastest < FULL_TICKS - 5


def test_the_keyboards_screen_says_in_a_line_that_the_link_is_late(rig: Rig) -> None:
    rig.actuator()
    with late_link(rig.port) as port:
        seat = rig.terminal("keyboard", *rig.bus_options(f"tcp/127.0.0.1:{port}"))
        seat.shows("nobody operates")
        seat.type("\x1b[A")
        seat.shows("driving", "at most 2.", "commands of keyboard are up to ")
        seat.type("q")
        seat.ends()
