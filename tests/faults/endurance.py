"""Half an hour of floods: does any process of the robot grow, and can it still be driven and stopped?

`python -m faults.endurance --minutes 30`
"""

import argparse
import sys
import time

from faults.usage import Usage, told, usage

from zteleop.chaos.bench import Bench, Subject
from zteleop.chaos.load import CROWD, FLOOD, KNOWN, LARGE
from zteleop.chaos.operators import here
from zteleop.chaos.people import press
from zteleop.config import Config

MOST = 10.0
"""MB that a process may grow"""
WARM, EVERY = 60.0, 120.0
"""s after which what is there counts as there from the start; s between two looks"""
BOUND = 0.05


def main() -> int:
    """Return 0 when nobody grew too much, and it stopped in time at the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=30.0)
    minutes = parser.parse_args().minutes
    if minutes < 4:
        parser.error("at least 4 minutes are meant, for two looks at the memory")
    with Bench(Subject(Config(), ("--driver", "simulated"))) as bench, here(bench):
        bench.until(lambda: not bench.eye.at_rest, 10.0)
        time.sleep(5.0)  # until the black box is there as well
        for flood in (FLOOD, KNOWN, CROWD, LARGE):
            flood(bench)
        began, alarms, rested = time.monotonic(), 0, False
        first: dict[str, Usage] = {}
        newest: dict[str, Usage] = {}
        tell_at = WARM
        while (passed := time.monotonic() - began) < 60 * minutes:
            rests = bench.eye.at_rest
            alarms, rested = alarms + (rests and not rested), rests
            if passed >= tell_at:
                tell_at += EVERY
                newest = usage(bench.watchdog.pid)
                first = first or newest
                print(f"{passed / 60:5.1f} min: {told(newest)}, at rest {alarms} times", flush=True)
            time.sleep(0.01)
        struck = time.monotonic()
        press(bench)
        stopped = bench.until(lambda: bench.eye.at_rest, 5.0)
    took = (stopped or float("inf")) - struck
    others = {name for name, before in first.items() if name not in newest or newest[name].pid != before.pid}
    grown = max(newest[name].mb - first[name].mb for name in first.keys() & newest.keys())
    print(
        f"grown by {grown:.1f} MB at most, came to rest {alarms} times, stopped within {1000 * took:.1f} ms"
    )
    return 0 if grown <= MOST and took <= BOUND and not others else 1


if __name__ == "__main__":
    sys.exit(main())
