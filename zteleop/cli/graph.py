import argparse
import json
from collections.abc import Iterable

from zteleop.bus.escape import printable
from zteleop.bus.topics import topic_of
from zteleop.cli import _options
from zteleop.cli._graph import Graph, graph
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop graph",
    "zteleop graph --dot",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("--dot", action="store_true", help="for Graphviz: zteleop graph --dot | dot -Tsvg")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        pass
    wanted = Graph([one for one in found.endpoints if arguments.robot in (None, one.robot)], [], found.robot)
    if not wanted.endpoints:
        raise BusError(found.nobody(arguments.robot))
    print(printable("\n".join(as_dot(wanted) if arguments.dot else as_text(wanted)), keep="\n"))


def as_text(found: Graph) -> Iterable[str]:
    """Yield each topic, with who says it before an arrow to whoever hears it."""
    topics = found.topics()
    width = max(map(len, topics))
    for topic, members in topics.items():
        said, heard = (
            ", ".join(sorted({one.node for one in members if one.kind == kind})) for kind in ("pub", "sub")
        )
        yield f"{topic:{width}}  {said or 'nobody'} -> {heard or 'nobody'}"


def as_dot(found: Graph) -> Iterable[str]:
    """Yield a drawing in Graphviz's words: nodes are ellipses, topics boxes."""
    yield "digraph zteleop {"
    yield "  rankdir=LR;"
    for topic in found.topics():
        yield f"  {json.dumps(topic)} [shape=box];"
    edges = set()
    for one in found.endpoints:
        node, topic = f"/{one.robot}/{one.node}", f"/{one.robot}/{topic_of(one.topic).name}"
        edges.add((node, topic) if one.kind == "pub" else (topic, node))
    for start, end in sorted(edges):
        yield f"  {json.dumps(start)} -> {json.dumps(end)};"
    yield "}"
