"""Do every fault many times and print how long the wheels turned on: `make faults`."""

import argparse
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from faults.faults import FAULTS, Fault, driven, measure, on_i2c
from rig import Rig


def main() -> int:
    """Return 0 when every fault kept its bound, every time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=50, help="how often each (default: 50)")
    parser.add_argument("--only", default="", help="the faults whose name holds this")
    parser.add_argument("--i2c", action="store_true", help="through smbus2 and an emulated /dev/i2c-1")
    options = parser.parse_args()
    prepare = on_i2c if options.i2c else lambda rig: None
    faults = [fault for fault in FAULTS if options.only in fault.name]
    print(f"{'fault':26} {'times':>5} {'median':>9} {'worst':>9} {'bound':>9}", flush=True)
    return sum(not report(fault, options.times, prepare) for fault in faults)


def report(fault: Fault, times: int, prepare: Callable[[Rig], object]) -> bool:
    """Do one fault, print its line, and say whether it kept its bound."""
    seconds = [once(fault, number, prepare) for number in range(times)]
    good = max(seconds) <= fault.bound
    figures = " ".join(f"{1000 * x:6.1f} ms" for x in (statistics.median(seconds), max(seconds), fault.bound))
    print(f"{fault.name:26} {times:5} {figures}  {'kept' if good else 'BROKEN'}", flush=True)
    return good


def once(fault: Fault, number: int, prepare: Callable[[Rig], object]) -> float:
    with (
        tempfile.TemporaryDirectory() as folder,
        driven(Path(folder), alone=fault.alone, prepare=prepare) as bench,
    ):
        time.sleep(number % 10 * 0.007)  # at another moment of every timer's period
        return measure(fault, bench)


if __name__ == "__main__":
    sys.exit(main())
