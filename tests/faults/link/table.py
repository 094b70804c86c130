"""Do every fault of the link many times and print what followed.

python -m faults.link.table        from tests/, as root
"""

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

from faults.link.faults import FAULTS, LinkFault
from faults.link.network import obstacle
from faults.link.trial import Outcome, attempt


def main() -> int:
    """Return 0 when every fault kept its bound, every time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=5, help="how often each (default: 5)")
    parser.add_argument("--only", default="", help="the faults whose name holds this")
    options = parser.parse_args()
    if obstacle():
        sys.exit(obstacle())
    faults = [fault for fault in FAULTS if options.only in fault.name]
    heads = "times", "median", "worst", "bound", "oldest", "stale", "share", "by itself"
    print(f"{'fault':32} {heads[0]:>5}", " ".join(f"{head:>9}" for head in heads[1:]), flush=True)
    return sum(not report(fault, options.times) for fault in faults)


def report(fault: LinkFault, times: int) -> bool:
    """Do one fault, print its line, and say whether it kept its bound."""
    outcomes = [once(fault, number) for number in range(times)]
    seconds = [outcome.seconds for outcome in outcomes if outcome.seconds is not None]
    late = fault.bound is not None and max(seconds, default=0.0) > fault.bound
    broken = next((outcome.broken for outcome in outcomes if outcome.broken), "too late" if late else "")
    median = statistics.median(seconds) if seconds else None
    figures = (median, max(seconds, default=None), fault.bound, max(x.oldest for x in outcomes))
    stale = sum(outcome.stale for outcome in outcomes)
    share = statistics.mean(outcome.share for outcome in outcomes)
    again = sum(outcome.ended == "drives" for outcome in outcomes)
    print(
        f"{fault.name:32} {times:5} {' '.join(_ms(figure) for figure in figures)}",
        f"{stale:9} {100 * share:7.0f} % {again:9}  {'BROKEN ' + broken if broken else 'kept'}",
        flush=True,
    )
    return not broken


def once(fault: LinkFault, number: int) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="zt-") as folder:
        try:
            return attempt(fault, Path(folder), number % 10 * 0.007, seed=number)
        except AssertionError as error:
            return Outcome(None, 0, 0.0, 0.0, "", str(error))


def _ms(seconds: float | None) -> str:
    return f"{1000 * seconds:6.1f} ms" if seconds is not None else f"{'-':>9}"


if __name__ == "__main__":
    sys.exit(main())
