"""A bad radio, for whoever wants to see what it does to a robot that costs nothing."""

import argparse

from zteleop.bus.bad_link import BadLink
from zteleop.bus.node import Node
from zteleop.cli import _options


def add(parser: argparse.ArgumentParser, whose: str) -> None:
    """Add the options that say how bad it is; `whose` words come late."""
    parser.add_argument(
        "--latency",
        metavar="TIME",
        type=_options.seconds,
        default=0.0,
        help=f"imitate a bad radio: {whose} comes so late, such as 200ms",
    )
    parser.add_argument(
        "--loss",
        metavar="SHARE",
        type=less_than_all,
        default=0.0,
        help="and so much of it never: 5%%",
    )


def worsen(node: Node, arguments: argparse.Namespace, seed: int = 0) -> None:
    """Make the link of a node as bad as was typed, for what it publishes from now on."""
    if arguments.latency or arguments.loss:
        node.membership.link = BadLink(node.membership.loop, arguments.latency, arguments.loss, seed)


def as_typed(arguments: argparse.Namespace) -> list[str]:
    """Return the options once more, for a verb that this one starts."""
    latency = ["--latency", f"{arguments.latency}s"] if arguments.latency else []
    return [*latency, *(["--loss", f"{arguments.loss}"] if arguments.loss else [])]


def less_than_all(text: str) -> float:
    """Return a share, as typed, of which something is left."""
    found = _options.share(text)
    if found == 1:
        raise argparse.ArgumentTypeError(f"expected less than all of it, found {text}")
    return found
