import argparse
from collections.abc import Iterable

from zteleop.cli import _options, _window
from zteleop.cli._listening import Arrival, listening
from zteleop.cli._window import Figures, Window

EXAMPLES = (
    "zteleop hz odom",
    "zteleop hz archangel/odom archangel/drive_status --window 100",
)
EVERY = 1.0
"""s between two lines"""
HEAD = ("topic", "rate", "min_delta", "max_delta", "std_dev", "window")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topics", metavar="topic", nargs="+", help="such as archangel/odom; several: a table")
    _window.add_argument(parser)


def run(arguments: argparse.Namespace) -> None:
    with listening("hz", arguments.topics, arguments) as (ears, names):
        paces = {f"/{name}": Pace(arguments.window) for name in names}
        for name in names:
            ears.hear(name, paces[f"/{name}"].hear)

        def tell() -> None:
            for line in _single(*paces.values()) if len(paces) == 1 else _table(paces):
                print(line, flush=True)

        ears.loop.every(EVERY, tell)
        ears.run()


class Pace:
    """How often a topic is said: the gaps between its newest messages."""

    def __init__(self, most: int) -> None:
        self.gaps = Window(most)
        self._at: float | None = None
        self._told: float | None = None

    def hear(self, arrival: Arrival) -> None:
        if self._at is not None:
            self.gaps.add(arrival.at - self._at)
        self._at = arrival.at

    @property
    def heard(self) -> bool:
        """Anything has been said at all."""
        return self._at is not None

    def news(self) -> Figures | None:
        """Return the figures of the gaps, in s; None when nothing was said since they were asked for last."""
        if self._at == self._told:
            return None
        self._told = self._at
        return self.gaps.figures


def _single(pace: Pace) -> Iterable[str]:
    if found := pace.news():
        yield f"average rate: {_rate_hz(found):.3f}"
        yield (
            f"\tmin: {found.least:.3f}s max: {found.largest:.3f}s std dev: {found.deviation:.5f}s "
            f"window: {found.messages}"
        )
    elif pace.gaps.values:
        yield "no new messages"


def _table(paces: dict[str, Pace]) -> Iterable[str]:
    """Yield a table of all topics that have been heard, once there is one."""
    if not any(pace.gaps.values for pace in paces.values()):
        return
    yield from _window.table([HEAD, *(_row(topic, pace) for topic, pace in paces.items())])


def _row(topic: str, pace: Pace) -> tuple[str, ...]:
    if found := pace.news():
        times = (found.least, found.largest, found.deviation)
        return (topic, f"{_rate_hz(found):.3f}", *(f"{value:.5f}" for value in times), str(found.messages))
    return (topic, "silent" if pace.heard else "not heard", *[""] * 4)


def _rate_hz(gaps: Figures) -> float:
    return 1 / gaps.mean if gaps.mean else 0.0
