import argparse
from collections import deque
from collections.abc import Iterable

from zteleop.bus import clock
from zteleop.cli import _options, _window
from zteleop.cli._listening import Arrival, listening

EXAMPLES = (
    "zteleop bw odom",
    "zteleop bw archangel/drive_status --window 20",
)
EVERY = 1.0
"""s between two lines"""
NEWEST = 100
UNITS = ((1e6, "MB"), (1e3, "KB"), (1.0, "B"))
"""decimal, as ROS writes them"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom")
    _window.add_argument(parser, NEWEST)


def run(arguments: argparse.Namespace) -> None:
    with listening("bw", [arguments.topic], arguments) as (ears, (name,)):
        sizes = Sizes(arguments.window)
        ears.hear(name, sizes.hear)

        def tell() -> None:
            for line in sizes.lines(clock.now()):
                print(line, flush=True)

        print(f"Subscribed to [/{name}]", flush=True)
        ears.loop.every(EVERY, tell)
        ears.run()


class Sizes:
    """How many bytes a topic's newest messages have, without what the bus wraps around them."""

    def __init__(self, most: int) -> None:
        self._newest: deque[tuple[float, int]] = deque(maxlen=most)

    def hear(self, arrival: Arrival) -> None:
        self._newest.append((arrival.at, len(arrival.sample.payload)))

    def lines(self, now: float) -> Iterable[str]:
        """Yield what the newest messages come to, as of now: a topic that falls silent counts ever less."""
        if len(self._newest) < 2 or now <= self._newest[0][0]:
            return
        sizes = [size for _, size in self._newest]
        rate = sum(sizes) / (now - self._newest[0][0])
        scale, unit = next(((scale, unit) for scale, unit in UNITS if rate >= scale), UNITS[-1])
        digits = 0 if unit == "B" else 2
        said = [
            f"{value / scale:.{digits}f} {unit}"
            for value in (sum(sizes) / len(sizes), min(sizes), max(sizes))
        ]
        yield f"{rate / scale:.{digits}f} {unit}/s from {len(sizes)} messages"
        yield f"\tMessage size mean: {said[0]} min: {said[1]} max: {said[2]}"
