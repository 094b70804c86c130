import argparse
import time
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from zteleop.bus import codec
from zteleop.cli import _options, _window
from zteleop.cli._listening import Arrival, Complaints, listening
from zteleop.cli._window import Window
from zteleop.errors import MessageError

EXAMPLES = (
    "zteleop delay odom",
    "zteleop delay archangel/odom --window 100",
)
HEAD = ("topic", "delay", "min", "max", "std_dev", "window")
EVERY = 1.0
"""s between two lines"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "topics",
        metavar="topic",
        nargs="+",
        help="such as archangel/odom, whose messages say when they were made; several: a table",
    )
    _window.add_argument(parser)


def run(arguments: argparse.Namespace) -> None:
    with listening("delay", arguments.topics, arguments) as (ears, names):
        delays, complaints = {f"/{name}": Delays(arguments.window) for name in names}, Complaints()

        def hear(topic: str, arrival: Arrival) -> None:
            try:
                delays[topic].hear(arrival, time.time())
            except MessageError as error:
                complaints.tell(f"{arrival.sample.key}: {error}")

        def tell() -> None:
            for line in table(delays) if len(delays) > 1 else next(iter(delays.values())).lines():
                print(line, flush=True)

        for name in names:
            ears.hear(name, partial(hear, f"/{name}"))
        ears.loop.every(EVERY, tell)
        ears.run()


class Delays:
    """How old messages are when they arrive, by their stamp and this machine's time of day."""

    def __init__(self, most: int) -> None:
        self._window = Window(most)
        self._new = False

    def hear(self, arrival: Arrival, today: float) -> None:
        """Take in a message that arrived at that time of day, in s; raises MessageError for one unstamped."""
        values = codec.decode_any(arrival.sample.payload, arrival.sample.encoding)
        self._window.add(today - _stamp(values))
        self._new = True

    @property
    def row(self) -> tuple[str, ...]:
        """What a table says of them."""
        new, self._new = self._new, False
        if not (found := self._window.figures) or not new:
            return ("silent" if found else "not heard", *[""] * (len(HEAD) - 2))
        times = (found.mean, found.least, found.largest)
        return (*(f"{value:.3f}" for value in times), f"{found.deviation:.5f}", str(found.messages))

    @property
    def heard(self) -> bool:
        """Anything has been said at all."""
        return self._window.figures is not None

    def lines(self) -> Iterable[str]:
        """Yield what they come to, in the words of ROS."""
        if not (found := self._window.figures):
            return
        if not self._new:
            yield "no new messages"
            return
        self._new = False
        yield f"average delay: {found.mean:.3f}"
        yield (
            f"\tmin: {found.least:.3f}s max: {found.largest:.3f}s std dev: {found.deviation:.5f}s "
            f"window: {found.messages}"
        )


def table(delays: Mapping[str, Delays]) -> Iterable[str]:
    """Yield a table of all topics, once one of them was heard."""
    if any(one.heard for one in delays.values()):
        yield from _window.table([HEAD, *((topic, *one.row) for topic, one in delays.items())])


def _stamp(values: Any) -> float:
    """Return when a message was made, in s since 1970, by its header or, where it has none, its own stamp."""
    inner = values.get("header", values) if isinstance(values, Mapping) else None
    stamp = inner.get("stamp") if isinstance(inner, Mapping) else None
    if not isinstance(stamp, Mapping) or not {"sec", "nanosec"} <= stamp.keys():
        raise MessageError("msg does not have header: nobody knows when it was made")
    return float(stamp["sec"]) + float(stamp["nanosec"]) * 1e-9
