"""Does a robot that somebody drives go on driving beside busy processes, and come back by itself?"""

import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from fnmatch import fnmatch
from itertools import groupby
from typing import NamedTuple

from figures import command_line, print_table
from interruptions import Witness
from operators import OPERATORS, PlacedRobot, Tend
from places import OUTAGE, PLACES, wifi_obstacle
from processes import running

from zteleop.bus import clock

AIMS = {0: 99.5, 2: 99.5, 4: 98.0}
"""% of the time driven, by how many processes are busy"""
SECONDS, QUICK = 120.0, 5.0
LOOK_EVERY = 0.005
START = 15.0
"""s until a robot must drive, before anything is busy"""
BUSY = [sys.executable, "-S", "-c", "while True: pass"]
HEAD = ["link", "busy", "operator", "driven %", "interrupted", "longest s", "ended", "aim", "causes"]


class Cell(NamedTuple):
    """One operator and one robot, at a place, beside busy processes."""

    place: str
    busy: int
    operator: str

    @property
    def name(self) -> str:
        return f"{self.place}/{self.busy}/{self.operator}"


CELLS = [Cell(place, busy, operator) for place in PLACES for busy in AIMS for operator in OPERATORS]


def measure(cells: Sequence[Cell], seconds: float) -> Iterator[list[object]]:
    """Drive the robots of one place and load, all at once; yield a row of the table for each."""
    with ExitStack() as stack:
        place = stack.enter_context(PLACES[cells[0].place](seconds))
        robots = [stack.enter_context(PlacedRobot(place)) for _ in cells]
        witnesses = [Witness(robot) for robot in robots]
        place.air.tend(clock.now())
        hands = [OPERATORS[cell.operator](robot) for cell, robot in zip(cells, robots, strict=True)]
        _await_motion(witnesses, hands)
        for _ in range(cells[0].busy):
            stack.enter_context(running(BUSY))
        _watch(witnesses, [*hands, place.air.tend], seconds)
        for cell, witness in zip(cells, witnesses, strict=True):
            yield _row(cell, witness, 100 * OUTAGE * place.air.outages / seconds)


def _await_motion(witnesses: list[Witness], hands: list[Tend]) -> None:
    """Drive until all have moved; who never does is locked out for the whole time."""
    give_up = clock.now() + START
    while not all(witness.moves for witness in witnesses) and (now := clock.now()) < give_up:
        for tend in hands:
            tend(now)
        time.sleep(LOOK_EVERY)


def _watch(witnesses: list[Witness], hands: list[Tend], seconds: float) -> None:
    began = now = clock.now()
    for witness in witnesses:
        witness.begin(now)
    while now < began + seconds:
        for tend in hands:
            tend(now)
        for witness in witnesses:
            witness.look(clock.now())
        time.sleep(LOOK_EVERY)
        now = clock.now()
    for witness in witnesses:
        witness.end(now)


def _row(cell: Cell, witness: Witness, link_took: float) -> list[object]:
    """Return a line of the table; nobody can drive while there is no link."""
    aim = AIMS[cell.busy] - link_took
    met = witness.share >= aim and not witness.locked_out
    lasted, unfinished = witness.lasted, int(witness.unfinished)
    ended = [f"{len(lasted) - unfinished} by itself"] * (len(lasted) > unfinished)
    ended += ["1 NEVER" if witness.locked_out else "1 not yet"] * unfinished
    causes = "; ".join(f"{times} x {why}" for why, times in witness.causes().most_common())
    figures = [f"{witness.share:.2f}", len(lasted), max(lasted, default=0.0), ", ".join(ended) or "-"]
    return [*cell[:3], *figures, f">= {aim:.1f}: {'met' if met else 'MISSED'}", causes or "-"]


@contextmanager
def looking_first() -> Iterator[None]:
    """Look at the chips before all ordinary processes, and so that no robot inherits it."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(1))
    except OSError:
        print("real-time priority is not permitted: what the witness itself missed is not in the table")
    try:
        yield
    finally:
        with suppress(OSError):
            os.sched_setscheduler(0, *before)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--seconds", type=float, help=f"a cell, default: {SECONDS:g}; soak: 600")
    parser.add_argument(
        "--cells", nargs="+", default=["*"], metavar="CELL", help=f"such as 'loopback/*', {CELLS[-1].name}"
    )
    options = parser.parse_args()
    seconds = options.seconds or (QUICK if options.quick else SECONDS)
    chosen = [cell for cell in CELLS if any(fnmatch(cell.name, wanted) for wanted in options.cells)]
    if not chosen:
        parser.error(f"no such cell; there are {', '.join(cell.name for cell in CELLS)}")
    if (why := wifi_obstacle()) and any(cell.place == "wifi" for cell in chosen):
        print(f"LOOPBACK ONLY: {why}")
        chosen = [cell for cell in chosen if cell.place == "loopback"]
    rows: list[list[object]] = []
    with looking_first():
        for (place, busy), cells in groupby(chosen, key=lambda cell: cell[:2]):
            print(f"{place}, {busy} busy: {seconds:g} s ...", file=sys.stderr, flush=True)
            rows += measure(list(cells), seconds)
    at_once = f"{os.cpu_count()} cores, all operators of a row's link and load at once, a robot each"
    print_table(f"driven under load, {seconds:g} s a cell, {at_once}", HEAD, rows)


if __name__ == "__main__":
    main()
