import argparse
import sys
from collections.abc import Iterable
from datetime import UTC, datetime
from os import environ

from zteleop.bus import clock, codec
from zteleop.bus.escape import printable
from zteleop.bus.presence import who_is_here
from zteleop.cli import _options
from zteleop.cli._listening import TELL_AFTER, Arrival, listening
from zteleop.errors import MessageError
from zteleop.messages import Log, Time
from zteleop.terminal.capabilities import wants_color

EXAMPLES = (
    "zteleop log",
    "zteleop log --level warn --node actuator",
)
LEVELS = {"debug": Log.DEBUG, "info": Log.INFO, "warn": Log.WARN, "error": Log.ERROR, "fatal": Log.FATAL}
COLORS = {Log.WARN: "33", Log.ERROR: "31", Log.FATAL: "1;31"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("--level", choices=[*LEVELS], default="info", help="nothing less than that (info)")
    parser.add_argument("-f", "--follow", action="store_true", help="what it does anyway: it goes on")
    parser.add_argument("--node", metavar="NAME", action="append", help="only of that node; may be repeated")


def run(arguments: argparse.Namespace) -> None:
    least, nodes = LEVELS[arguments.level], frozenset(arguments.node or ())
    color = sys.stdout.isatty() and wants_color(environ)
    with listening("log", ["log"], arguments) as (ears, (name,)):
        ears.patient = False
        print(
            f"zteleop log: what {name.robot} says from now on; what it said: zteleop blackbox",
            file=sys.stderr,
        )

        def show(arrival: Arrival) -> None:
            for line in lines(arrival, least, nodes, color):
                print(line, flush=True)

        def miss() -> None:
            robots = {one.robot for one in ears.endpoints() if one.kind == "pub"}
            if name.robot not in robots:
                words = (
                    f"{name.robot} is not heard so far; {who_is_here(robots, name.robot, ears.unreached())}"
                )
                print(printable(f"zteleop log: {words}"), file=sys.stderr, flush=True)

        ears.hear(name, show)
        ears.loop.alarm(miss).ring_at(clock.now() + TELL_AFTER)
        ears.run()


def lines(arrival: Arrival, least: int, nodes: Iterable[str], color: bool) -> Iterable[str]:
    """Yield a line for what a node logs, if it is wanted; for what is no log, nothing."""
    try:
        said = codec.decode(arrival.sample.payload, arrival.sample.encoding, codec.decoders([Log]))
    except MessageError as error:
        yield printable(f"{arrival.sample.key}: {error}")
        return
    if isinstance(said, Log) and said.level >= least and (not nodes or said.name in nodes):
        level = next((word for word, number in LEVELS.items() if number == said.level), f"{said.level}")
        text = printable(f"[{level.upper()}] [{clock_of(said.stamp)}] [{said.name}]: {said.msg}")
        yield f"\x1b[{COLORS[said.level]}m{text}\x1b[0m" if color and said.level in COLORS else text


def clock_of(stamp: Time) -> str:
    """Return a moment as the clock of whoever reads it shows it."""
    return f"{datetime.fromtimestamp(stamp.sec, UTC).astimezone():%H:%M:%S}.{stamp.nanosec // 1_000_000:03}"
