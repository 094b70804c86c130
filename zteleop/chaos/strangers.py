"""Attacks that anybody on an open network can do; each begins while somebody drives, and goes on."""

import sys
from functools import partial

from zteleop.chaos.bench import START, Bench, endpoint
from zteleop.chaos.fault import Act, Fault
from zteleop.chaos.load import count_alarms
from zteleop.chaos.people import press
from zteleop.chaos.process import Process
from zteleop.chaos.stranger import ATTACKS
from zteleop.errors import BusError

POISON = "a declaration that is none"
"""Breaks zenoh: the robot rests until another door is open."""


def begin(attack: str, bench: Bench, where: str = "", name: str = "stranger") -> Process:
    """Start a stranger, at the bench's own door or another; it says "strikes" when it does.

    It ends with the bench.
    """
    where = where or endpoint(bench.place.address)
    return bench.run(name, [sys.executable, "-m", "zteleop.chaos.stranger", attack, where, bench.place.robot])


def strike(attack: str, bench: Bench) -> None:
    """Begin an attack; it ends with the bench."""
    process = begin(attack, bench)
    if bench.until(lambda: process.words == "strikes", START) is None:
        raise BusError(f"the stranger does not strike: {process.words}")


def attacked(attack: str, then: Act) -> Act:
    """Begin an attack, and do something beside it."""

    def act(bench: Bench) -> object:
        strike(attack, bench)
        return then(bench)

    return act


def _faults(attack: str) -> tuple[Fault, ...]:
    drives = partial(strike, attack) if attack == POISON else attacked(attack, count_alarms)
    return (
        Fault(attack, drives, None, "drives"),
        Fault(f"{attack}, stop", press, before=partial(strike, attack)),
    )


FAULTS = tuple(fault for attack in ATTACKS for fault in _faults(attack))
