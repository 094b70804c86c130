import argparse
from collections import deque
from collections.abc import Iterable, Mapping

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
HEAD = ("topic", "rate", "mean", "min", "max", "messages")
UNITS = ((1e6, "MB"), (1e3, "KB"), (1.0, "B"))
"""decimal, as ROS writes them"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topics", metavar="topic", nargs="+", help="such as archangel/odom; several: a table")
    _window.add_argument(parser, NEWEST)


def run(arguments: argparse.Namespace) -> None:
    with listening("bw", arguments.topics, arguments) as (ears, names):
        sizes = {f"/{name}": Sizes(arguments.window) for name in names}
        for name in names:
            ears.hear(name, sizes[f"/{name}"].hear)

        def tell() -> None:
            now = clock.now()
            for line in table(sizes, now) if len(sizes) > 1 else next(iter(sizes.values())).lines(now):
                print(line, flush=True)

        for topic in sizes:
            print(f"Subscribed to [{topic}]", flush=True)
        ears.loop.every(EVERY, tell)
        ears.run()


class Sizes:
    """How many bytes a topic's newest messages have, without what the bus wraps around them."""

    def __init__(self, most: int) -> None:
        self._newest: deque[tuple[float, int]] = deque(maxlen=most)
        self._news = False

    def hear(self, arrival: Arrival) -> None:
        self._newest.append((arrival.at, len(arrival.sample.payload)))
        self._news = True

    def figures(self, now: float) -> tuple[str, ...]:
        """Return what the newest messages come to, as of now: a topic that falls silent counts ever less.

        Their rate, their mean, least and largest size, and how many they are; nothing of less than two.
        """
        if len(self._newest) < 2 or now <= self._newest[0][0]:
            return ()
        sizes = [size for _, size in self._newest]
        rate = sum(sizes) / (now - self._newest[0][0])
        scale, unit = next(((scale, unit) for scale, unit in UNITS if rate >= scale), UNITS[-1])
        digits = 0 if unit == "B" else 2
        said = (
            f"{value / scale:.{digits}f} {unit}"
            for value in (sum(sizes) / len(sizes), min(sizes), max(sizes))
        )
        return (f"{rate / scale:.{digits}f} {unit}/s", *said, str(len(sizes)))

    def take_news(self) -> bool:
        """Say whether anything came since this was last asked."""
        news, self._news = self._news, False
        return news

    def lines(self, now: float) -> Iterable[str]:
        """Yield the figures in the words of ROS; where nothing came since, that."""
        if not self.take_news() and self._newest:
            yield "no new messages"
        elif found := self.figures(now):
            rate, mean, least, largest, count = found
            yield f"{rate} from {count} messages"
            yield f"\tMessage size mean: {mean} min: {least} max: {largest}"


def table(sizes: Mapping[str, Sizes], now: float) -> Iterable[str]:
    """Yield a table of all topics, once one of them was heard."""
    found = {topic: one.figures(now) for topic, one in sizes.items()}
    if any(found.values()):
        rows = [(topic, *_row(row, sizes[topic].take_news())) for topic, row in found.items()]
        yield from _window.table([HEAD, *rows])


def _row(figures: tuple[str, ...], news: bool) -> tuple[str, ...]:
    """Return the cells of a topic: of one from which nothing came since, no rate."""
    empty = [""] * (len(HEAD) - 2)
    if not figures:
        return ("not heard", *empty)
    return figures if news else ("silent", *empty)
