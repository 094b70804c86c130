"""Do a fault to a link and see what follows; the judgement needs nobody's word but the chip's."""

import time
from pathlib import Path
from typing import NamedTuple

from faults.link.bench import FRESH, LinkBench
from faults.link.faults import LinkFault
from faults.link.network import Network
from rig import until
from verdict import meter

SETTLE = 0.2
"""s of undisturbed driving"""
QUIET = 0.7
"""s for which a robot that rests is watched once its operator hears it again"""
RESUMES = 1.5
"""s in which it may drive again by itself"""


class Outcome(NamedTuple):
    """What one trial has shown."""

    seconds: float | None
    """until the wheels were at rest; None where they need not be"""
    stale: int
    """commands executed that were too old"""
    oldest: float
    """s, of any command executed since the fault began"""
    share: float
    """of what was commanded under the fault that was executed"""
    ended: str
    """whether it went on by itself afterwards"""
    broken: str = ""
    """What should not have happened, in words."""
    waited: float = 0.0
    """s until rest for which processes wanted a core and had none"""


def attempt(fault: LinkFault, folder: Path, moment: float = 0.0, seed: int = 0) -> Outcome:
    """Do a fault once, `moment` seconds after the robot moves."""
    folder.mkdir(exist_ok=True)
    options = ["--rate", str(fault.rate), *(["--standing"] if fault.standing else [])]
    with Network(seed) as network, LinkBench(network, folder, operator=options, router=fault.router) as bench:
        time.sleep(SETTLE + moment)
        return judge(bench, fault)


def judge(bench: LinkBench, fault: LinkFault) -> Outcome:
    """Do a fault and say what followed."""
    its, struck = meter(bench.rig), time.monotonic()
    fault.strike(bench)
    if fault.bound is not None:
        until(lambda: its.glance() or bench.at_rest, f"neutral: {fault.name}")
    rested, waited = time.monotonic(), its.waited
    seconds = None if fault.bound is None else rested - struck
    time.sleep(max(0.0, struck + fault.lasts - time.monotonic()))
    undone = time.monotonic()
    fault.undo(bench)
    ended, broken = _follow(bench, fault, rested, undone)
    share = bench.witness.moved(struck, undone) / max(1.0, fault.rate * (undone - struck))
    witness = bench.witness
    broken = broken or _find_fault(bench)
    return Outcome(seconds, witness.stale, witness.oldest(struck), share, ended, broken, waited)


def _follow(bench: LinkBench, fault: LinkFault, rested: float, undone: float) -> tuple[str, str]:
    """Say how it went on, and what was wrong with that."""
    bench.is_heard_again()
    if fault.then == "drives":
        until(lambda: bench.witness.moved(undone), f"motion: {fault.name}")
        return "drives", ""
    quiet = QUIET if fault.then == "rests" else RESUMES
    since = rested if fault.then == "rests" else undone
    moves = _moves_within(bench, quiet, since)
    if moves and fault.then == "rests":
        return "drives", "it moved without being begun anew"
    if not moves:
        bench.begin_anew()
        bench.moves()
    return "drives" if moves else "rests", ""


def _moves_within(bench: LinkBench, patience: float, since: float) -> bool:
    give_up = time.monotonic() + patience
    while time.monotonic() < give_up and not bench.witness.moved(since):
        time.sleep(0.001)
    return bench.witness.moved(since) > 0


def _find_fault(bench: LinkBench) -> str:
    """Say what must never happen, whatever the fault is."""
    if bench.witness.stale:
        return f"{bench.witness.stale} commands were executed more than {FRESH:g} s after they were sent"
    if bench.witness.strange:
        return f"pulses that nobody commanded: {bench.witness.strange}"
    return f"a false alarm: {bench.alarms[0]}" if bench.alarms else ""
