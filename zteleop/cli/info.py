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
        those = [member for member in members if member.kind == kind]
        if verbose:
            yield ""
        yield f"{called} count: {len(those)}"
        if verbose:
            for member in those:
                yield from ("", *_endpoint(member))


def _endpoint(member: Endpoint) -> Iterable[str]:
    yield f"Node name: {member.node}"
    yield f"Node namespace: /{member.robot}"
    yield f"Process: {member.process}"
    yield f"Topic: /{member.robot}/{member.topic}"
    yield f"Topic type: {member.type}"
    if member.hash:
        yield f"Topic type hash: {member.hash}"
    yield f"Endpoint type: {KINDS[member.kind][1]}"
