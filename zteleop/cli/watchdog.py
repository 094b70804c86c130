import argparse
import sys

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.subscription import Received
from zteleop.cli import _options
from zteleop.cli.why import state_of
from zteleop.errors import BusError
from zteleop.messages import WatchdogStatus

EXAMPLES = (
    "zteleop watchdog",
    "zteleop watchdog archangel --once",
)
LINE_EVERY = 1.0
HEARD_WITHIN = 1.5


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    parser.add_argument("--once", action="store_true", help="print one line and end")


def run(arguments: argparse.Namespace) -> None:
    """Print a line a second, and one at each change."""
    with _options.join("watch", _options.load_anyhow(arguments)) as node:
        shown: tuple[object, ...] = ()
        heard_at = shown_at = clock.now()

        def show(received: Received[WatchdogStatus]) -> None:
            nonlocal shown, shown_at, heard_at
            dog, heard_at = received.message, received.at
            news = (dog.state, dog.why, dog.moving, dog.allowed, dog.restarts)
            if news != shown or heard_at - shown_at >= LINE_EVERY:
                shown, shown_at = news, heard_at
                print(printable(f"{node.robot}  {state_of(dog)}; {dog.commands} commands heard"), flush=True)
                if arguments.once:
                    node.stop()

        @node.every(HEARD_WITHIN / 4)
        def notice_silence() -> None:
            if clock.now() - heard_at > HEARD_WITHIN:
                here = presence.here(node.membership.session, node.robot)
                raise BusError(
                    f"no watchdog of {node.robot} has been heard for {HEARD_WITHIN:g} s ({here}); "
                    "if the robot moves, cut its power; else start zteleop actuator"
                )

        node.subscription("watchdog", WatchdogStatus, show)
        if sys.stderr.isatty() and not arguments.once:
            print("Ctrl-C ends this, and nothing of the robot", file=sys.stderr)
        node.spin()
