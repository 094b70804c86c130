"""What takes its time on a bus, measured where it is done; tests/timing/test_i2cdev.py judges it.

python -m preload.timed NAME      says in JSON how many s one of them took, and how many of those had no core
"""

import json
import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from preload.contract import DRIVEN, Bench, fails
from preload.device import DeviceBench
from zteleop.chaos.waiting import Meter


def hangs(ms: int) -> Callable[[Bench], Callable[[], None]]:
    """Let three transfers hang, which is one write with all its attempts."""

    def prepare(bench: Bench) -> Callable[[], None]:
        driver = bench.started()
        bench.faults.hang(3, ms)

        def write() -> None:
            with fails("no transfer within 20 ms"):
                driver.write(DRIVEN)

        return write

    return prepare


def slow(bench: Bench) -> Callable[[], None]:
    """Let two write at once to a bus that takes 20 ms each time."""
    drivers = [bench.started(), bench.driver()]
    bench.faults.slow(20)

    def write() -> None:
        with ThreadPoolExecutor(2) as people:
            list(people.map(lambda driver: driver.write(DRIVEN), drivers))

    return write


TIMED = {"hangs for 10 ms": hangs(10), "hangs": hangs(1000), "slow": slow}


def measure(name: str, bench: Bench) -> tuple[float, float]:
    """Return the seconds that it took, and those that this process waited for a core."""
    act = TIMED[name](bench)
    meter, began = Meter(lambda: [os.getpid()]), time.monotonic()
    act()
    return time.monotonic() - began, meter.waited


if __name__ == "__main__":
    bench = DeviceBench(os.environ["ZTELEOP_I2CDEV_FILE"])
    json.dump(measure(sys.argv[1], bench), sys.stdout)
    bench.close()
