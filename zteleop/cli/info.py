import argparse
from collections.abc import Iterable

from zteleop.bus.escape import printable
from zteleop.bus.presence import Endpoint
from zteleop.cli import _company, _options
from zteleop.cli._graph import graph, types_of

EXAMPLES = (
    "zteleop info drive_status",
    "zteleop info archangel/drive_status --verbose",
)
KINDS = {"pub": ("Publisher", "PUBLISHER"), "sub": ("Subscription", "SUBSCRIPTION")}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom, or odom with --robot")
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="with everybody who publishes or hears it"
    )


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        _, members = found.topic(arguments.topic)
    for line in lines(members, arguments.verbose):
        print(printable(line, keep="\n"))


def lines(members: list[Endpoint], verbose: bool) -> Iterable[str]:
    """Yield what ros2 says of a topic, in its words."""
    yield f"Type: {', '.join(types_of(members))}"
    yield from (f"Types disagree: {words}" for words in _company.disagreements(members))
    for kind, (called, _) in KINDS.items():
        nodes = _by_node(member for member in members if member.kind == kind)
        if verbose:
            yield ""
        yield f"{called} count: {len(nodes)}"
        if verbose:
            for those in nodes:
                yield from ("", *_node(those))


def _by_node(members: Iterable[Endpoint]) -> list[list[Endpoint]]:
    """Group by node: one that says a command by each of its keys says it once."""
    found: dict[tuple[str, str, str], list[Endpoint]] = {}
    for member in members:
        found.setdefault((member.robot, member.node, member.process), []).append(member)
    return list(found.values())


def _node(those: list[Endpoint]) -> Iterable[str]:
    """Yield who it is, and what it says or hears, which may be several of a topic's keys and types."""
    first = those[0]
    yield f"Node name: {first.node}"
    yield f"Node namespace: /{first.robot}"
    yield f"Process: {first.process}"
    yield f"Topic: {_each(f'/{one.robot}/{one.topic}' for one in those)}"
    yield f"Topic type: {_each(one.type for one in those)}"
    if hashes := _each(one.hash for one in those):
        yield f"Topic type hash: {hashes}"
    yield f"Endpoint type: {KINDS[first.kind][1]}"


def _each(names: Iterable[str]) -> str:
    return ", ".join(filter(None, dict.fromkeys(names)))
