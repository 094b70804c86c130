"""Do a fault to a robot and see what follows; the judgement needs nobody's word but the chip's."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from zteleop.chaos.bench import Bench, Subject
from zteleop.chaos.fault import Fault
from zteleop.chaos.operators import OPERATORS
from zteleop.chaos.waiting import Meter, Verdict
from zteleop.chaos.waiting import judge as judge_time
from zteleop.errors import BusError

DRIVEN_WITHIN = 10.0
QUIET = 0.6
"""s for which a robot that rests is watched"""
GIVE_UP = 5.0
"""s after which wheels that still turn are not waited for any longer"""


class Outcome(NamedTuple):
    """What one trial has shown."""

    seconds: float | None
    """until the wheels were at rest; None where they need not be, or never were"""
    broken: str = ""
    """What should not have happened, in words."""
    notes: tuple[str, ...] = ()
    """What is worth saying besides."""
    waited: float = 0.0
    """s for which whoever had to bring them to rest wanted a core and had none"""

    def verdict(self, bound: float | None) -> Verdict:
        """Say whether its bound was kept, as far as the machine let it be seen."""
        return (
            "in time"
            if self.seconds is None or bound is None
            else judge_time(self.seconds, bound, self.waited)
        )


@contextmanager
def driven(subject: Subject, fault: Fault) -> Iterator[Bench]:
    """Start a robot and somebody who drives it; raises BusError when it does not move."""
    with Bench(subject) as bench:
        bench.await_ready()
        fault.before(bench)
        with OPERATORS[fault.operator](bench):
            if bench.until(lambda: not bench.eye.at_rest, DRIVEN_WITHIN) is None:
                raise BusError(f"the robot does not drive: {bench.watchdog.words}")
            yield bench


def attempt(subject: Subject, fault: Fault, moment: float = 0.0) -> Outcome:
    """Do a fault once, `moment` seconds after the robot moves."""
    with driven(subject, fault) as bench:
        time.sleep(moment)  # so that each meets another moment of every timer's period
        return judge(bench, fault)


def judge(bench: Bench, fault: Fault) -> Outcome:
    """Do a fault and say what followed."""
    meter, began = Meter(bench.path), time.monotonic()
    said = fault.strike(bench)
    if isinstance(said, str) and said:
        return Outcome(None, said, tuple(bench.notes))
    if isinstance(said, float):  # it took its time, which is nobody's wait
        meter, began = Meter(bench.path), said
    seconds = None
    if fault.bound is not None:
        rested = bench.until(lambda: _rests(bench, meter), GIVE_UP)
        if rested is None:
            return Outcome(None, f"its wheels still turned {GIVE_UP:g} s later", tuple(bench.notes))
        seconds = rested - began
    waited = meter.waited
    fault.afterwards(bench)
    return Outcome(seconds, _what_follows(bench, fault), tuple(bench.notes), waited)


def _rests(bench: Bench, meter: Meter) -> bool:
    rests = bench.eye.at_rest
    if not rests:  # only then: to read what a dying process waited for may take 30 ms
        meter.glance()
    return rests


def _what_follows(bench: Bench, fault: Fault) -> str:
    if fault.then == "rests" and bench.until(lambda: not bench.eye.at_rest, QUIET) is not None:
        return "it moved again without being begun anew"
    if fault.then == "drives":
        time.sleep(QUIET)
    if fault.then == "drives" and bench.until(lambda: not bench.eye.at_rest, GIVE_UP) is None:
        return f"it did not drive again within {GIVE_UP:g} s: {bench.watchdog.words}"
    return ""
