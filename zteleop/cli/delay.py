import argparse
import time
from collections.abc import Iterable, Mapping
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
EVERY = 1.0
"""s between two lines"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom; its messages must say when they were made")
    _window.add_argument(parser)


def run(arguments: argparse.Namespace) -> None:
    with listening("delay", [arguments.topic], arguments) as (ears, (name,)):
        delays, complaints = Delays(arguments.window), Complaints()

        def hear(arrival: Arrival) -> None:
            try:
                delays.hear(arrival, time.time())
            except MessageError as error:
                complaints.tell(f"{arrival.sample.key}: {error}")

        def tell() -> None:
            for line in delays.lines():
                print(line, flush=True)

        ears.hear(name, hear)
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

    def lines(self) -> Iterable[str]:
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


def _stamp(values: Any) -> float:
    """Return when a message was made, in s since 1970, by its header or, where it has none, its own stamp."""
    inner = values.get("header", values) if isinstance(values, Mapping) else None
    stamp = inner.get("stamp") if isinstance(inner, Mapping) else None
    if not isinstance(stamp, Mapping) or not {"sec", "nanosec"} <= stamp.keys():
        raise MessageError("msg does not have header: nobody knows when it was made")
    return float(stamp["sec"]) + float(stamp["nanosec"]) * 1e-9
