"""What can happen between a robot and its operator, and what must follow."""

import signal
from collections.abc import Callable
from typing import Literal, NamedTuple

from faults.link.bench import LinkBench
from faults.link.emulator import Way
from faults.link.network import DEAD, SOUND

Act = Callable[[LinkBench], object]
Then = Literal["rests", "drives", "either"]
ROAMED = "10.77.0.3"
OUTAGE = 0.45
"""s until the wheels rest when nothing more is heard, or commands arrive and prove less and less"""
THIN = Way(rate=64_000, queue=20)
SHARED = Way(rate=1_000_000, delay=0.01, queue=60)


def nothing(bench: LinkBench) -> None:
    """Leave it as it is."""


class LinkFault(NamedTuple):
    """Something that is done to the link while the robot is driven over it, and undone after a while."""

    name: str
    strike: Act
    bound: float | None = OUTAGE
    """s until its wheels are at rest; None where it may drive on"""
    lasts: float = 1.0
    """s"""
    then: Then = "rests"
    """What follows while its operator goes on. `rests`: nothing moves it, even when the fault is over, until
    it is begun anew; `drives`: it goes on by itself; `either`: by itself, or when it is begun anew."""
    undo: Act = lambda bench: bench.network.set(SOUND)
    rate: int = 50
    """commands a second"""
    standing: bool = False
    """The operator acted once, and repeats that command."""
    router: bool = False
    """Both are clients of a router."""
    short: bool = True
    """It belongs to the short list."""


def link(forth: Way, back: Way | None = None) -> Act:
    return lambda bench: bench.network.set(forth, back)


def stop_robot(bench: LinkBench) -> None:
    bench.watchdog.signal(signal.SIGTERM)


def kill_operator(bench: LinkBench) -> None:
    bench.operator.signal(signal.SIGKILL)


def kill_both(bench: LinkBench) -> None:
    stop_robot(bench)
    kill_operator(bench)


def start_robot(bench: LinkBench) -> None:
    bench.watchdog.ends()
    bench.start_robot()


def start_operator(bench: LinkBench) -> None:
    bench.operator.ends()
    bench.start_operator()


def start_robot_first(bench: LinkBench) -> None:
    start_robot(bench)
    start_operator(bench)


def start_operator_first(bench: LinkBench) -> None:
    """Start somebody who drives before there is a robot, as a program does that runs on."""
    start_operator(bench)
    bench.operator.says("is not heard")
    start_robot(bench)


def roam(bench: LinkBench) -> None:
    bench.network.move_operator(ROAMED)


def kill_router(bench: LinkBench) -> None:
    bench.router.signal(signal.SIGKILL)


def start_router(bench: LinkBench) -> None:
    bench.router.ends()
    bench.start_router()


def watch_pictures(bench: LinkBench) -> None:
    bench.start_video()
    bench.network.set(SHARED)


FAULTS = (
    LinkFault("cable cut for 3 s", link(DEAD), lasts=3.0),
    LinkFault("cable cut for 3 s, 20 Hz", link(DEAD), lasts=3.0, rate=20, short=False),
    LinkFault("cable cut for 10 s", link(DEAD), lasts=10.0, short=False),
    LinkFault("cable cut for 1 s", link(DEAD), lasts=1.0, then="either", short=False),
    LinkFault("old standing command returns", link(DEAD), lasts=2.5, standing=True),
    LinkFault("nothing reaches the robot", link(DEAD, SOUND), lasts=2.5, short=False),
    LinkFault("nothing comes from the robot", link(SOUND, DEAD), lasts=2.5),
    LinkFault("10 % lost", link(Way(loss=0.1)), None, 2.0, "either", short=False),
    LinkFault("30 % lost", link(Way(loss=0.3)), None, 4.0, "either", short=False),
    LinkFault("50 % lost", link(Way(loss=0.5)), None, 3.0, "either", short=False),
    LinkFault("20 ms and jitter", link(Way(delay=0.02, jitter=0.01)), None, 1.0, "drives", short=False),
    LinkFault("100 ms and jitter", link(Way(delay=0.1, jitter=0.02)), None, 2.0, "drives"),
    LinkFault("250 ms and jitter", link(Way(delay=0.25, jitter=0.05)), OUTAGE, 3.0, "rests", short=False),
    LinkFault("500 ms and jitter", link(Way(delay=0.5, jitter=0.1)), OUTAGE, 3.0, "rests", short=False),
    LinkFault("450 ms, forth only", link(Way(delay=0.45), SOUND), OUTAGE, 3.0, short=False),
    LinkFault("100 ms, 20 Hz", link(Way(delay=0.1)), None, 2.0, "drives", rate=20, short=False),
    LinkFault("reordered", link(Way(delay=0.03, overtaking=0.25)), None, 1.5, "drives"),
    LinkFault("64 kbit/s", link(THIN), None, 4.0, "either", short=False),
    LinkFault("64 kbit/s, 20 Hz", link(THIN), None, 3.0, "either", rate=20, short=False),
    LinkFault("operator's address changes", roam, then="either", undo=nothing),
    LinkFault("router killed", kill_router, then="either", undo=start_router, router=True),
    LinkFault("robot restarted", stop_robot, 0.1, 0.0, undo=start_robot),
    LinkFault("operator restarted", kill_operator, lasts=0.5, then="drives", undo=start_operator),
    LinkFault("both restarted, robot first", kill_both, 0.1, 0.0, "drives", start_robot_first, short=False),
    LinkFault("both restarted, operator first", kill_both, 0.1, 0.0, undo=start_operator_first),
    LinkFault("pictures on a thin link", watch_pictures, None, 4.0, "either", short=False),
)
