"""The node whose parameters are meant on the command line."""

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.node_parameters import NodeParameters
from zteleop.bus.session import open_session
from zteleop.cli import _options
from zteleop.cli._graph import find_node


@contextmanager
def parameters_of(arguments: argparse.Namespace) -> Iterator[NodeParameters]:
    """Join the bus, and yield the parameters of the node meant; raises BusError when it is not there."""
    settings = _options.load_anyhow(arguments)
    with open_session(settings.bus, settle=True) as session:
        known = presence.with_parameters(session)
        robot, node = find_node(arguments.node, known, settings.robot)
        several = [one for one in known if (one.robot, one.node) == (robot, node)]
        if len(several) > 1:
            where = " and ".join(one.process for one in several)
            words = f"{len(several)} nodes are called /{robot}/{node}, on {where}; one of them answers"
            print(printable(f"zteleop param: warning: {words}"), file=sys.stderr)
        yield NodeParameters(session, robot, node)
