"""The link between operator and robot: cut, one-sided, slow, thin, and back again."""

import time

from zteleop.chaos.bench import Bench
from zteleop.chaos.fault import Act, Fault

LONG = 2.5
"""s, after which whoever drives must begin anew"""


def cut(*, forth: bool = True, back: bool = True) -> Act:
    return lambda bench: bench.link.cut(forth=forth, back=back)


def come_back(bench: Bench) -> None:
    """Let what waited for a long time arrive all at once."""
    time.sleep(LONG)
    bench.link.mend()


def come_back_soon(bench: Bench) -> None:
    bench.link.mend()


def slow(seconds: float) -> Act:
    def strike(bench: Bench) -> None:
        bench.link.delay = seconds

    return strike


def choke(bench: Bench) -> None:
    """Leave 500 bytes a second for what is 50 commands a second."""
    bench.link.rate = 500.0


FAULTS = (
    Fault("link cut", cut(), 0.45, operator="far"),
    Fault("link cut towards the robot", cut(back=False), 0.45, operator="far"),
    Fault("link cut from the robot", cut(forth=False), 0.45, operator="far"),
    Fault("link back after 3 s", cut(), 0.45, operator="far", afterwards=come_back),
    Fault("link back at once", cut(), 0.45, "drives", operator="far", afterwards=come_back_soon),
    Fault("link slower by 50 ms", slow(0.05), None, "drives", operator="far"),
    Fault("link slower by half a second", slow(0.5), 0.45, operator="far"),
    Fault("link of 4 kbit/s", choke, 0.45, operator="far"),
)
