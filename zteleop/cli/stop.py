import argparse

from zteleop.bus import clock
from zteleop.bus.escape import printable
from zteleop.bus.node import Node
from zteleop.cli import options
from zteleop.errors import BusError
from zteleop.messages import DriveStatus
from zteleop.nodes.stopping import PATIENCE, Stopping, person


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add(parser)
    options.add_robot(parser)
    parser.add_argument("--release", action="store_true", help="let it drive again, from neutral")
    parser.add_argument("--why", metavar="TEXT", default="", help="a reason, for others to read")


def run(arguments: argparse.Namespace) -> None:
    with options.join("stop", options.load_anyhow(arguments)) as node:
        print(printable(release(node) if arguments.release else stop(node, arguments.why)))


def stop(node: Node, why: str = "") -> str:
    """Stop the node's robot and return what to tell; BusError when it does not acknowledge it."""
    stopping = Stopping(node, person())
    stopping.engage(clock.now(), why)  # before anything else is set up: somebody waits for it
    words = _answer(node, stopping)
    return f"{words}; zteleop stop --release {node.robot} lets it drive again, from neutral"


def release(node: Node) -> str:
    """End the stop that the node's robot shows and return what to tell; BusError when it does not."""
    statuses = node.subscription("drive_status", DriveStatus)
    stopping = Stopping(node, person())
    stopping.release(node.until(statuses.newest, PATIENCE), clock.now())
    return _answer(node, stopping)


def _answer(node: Node, stopping: Stopping) -> str:
    node.subscription("drive_status", DriveStatus, lambda heard: stopping.heed(heard.message, heard.at))
    node.until(lambda: stopping.heed(None, clock.now()), 2 * PATIENCE)
    if stopping.state != "done":
        raise BusError(stopping.words)
    return stopping.words
