import argparse
from collections.abc import Sequence
from importlib.metadata import version
from importlib.util import find_spec

from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._driving import find_vehicle
from zteleop.config import Config
from zteleop.errors import DeviceError, install

EXAMPLES = (
    "zteleop web",
    "zteleop web archangel --port 8000",
)
HERE, PORT = "127.0.0.1", 8765
"""where pages are served: on this machine alone"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    of = f"of {HERE}; 0 is any that is free (default: {PORT})"
    parser.add_argument("--port", type=port, default=PORT, metavar="N", help=of)
    parser.add_argument(
        "--host",
        metavar="NAME",
        action="append",
        default=[],
        help="another name by which a browser reaches this server, as that of a tunnel; may be repeated",
    )


def run(arguments: argparse.Namespace) -> None:
    expect_websockets()
    settings = _options.load(arguments)
    with _options.join("web", settings) as node:
        drive_from_page(node, settings, arguments.port, arguments.host)


def expect_websockets() -> None:
    """Raise DeviceError where what serves a page is not installed."""
    if find_spec("websockets") is None:
        raise DeviceError(f"a page needs websockets, which is not installed; say: {install('web')}")


def drive_from_page(node: Node, settings: Config, port: int = PORT, hosts: Sequence[str] = ()) -> None:
    """Serve a page, print its address, and drive by whatever is held on it until the node is stopped.

    Raises BusError where the port is taken.
    """
    from zteleop.bridges.web.cockpit import Cockpit
    from zteleop.bridges.web.server import Server
    from zteleop.bridges.web.serving import serving
    from zteleop.bridges.web.tickets import Tickets, new_token

    token = new_token()
    with Call(settings.bus) as lane:
        cockpit = Cockpit(node, find_vehicle(node, settings), version("zteleop"), lane)
        server = Server(Tickets(token, hosts), cockpit, node.log.warn)
        with serving(server, HERE, port) as where:
            print(f"open http://{HERE}:{where}/#t={token}", flush=True)
            print(f"it drives {node.robot}, for whoever knows this address; Ctrl-C ends it", flush=True)
            cockpit.run()


def port(text: str) -> int:
    """Return a port, as typed."""
    if not (text.isdecimal() and len(text) <= 5 and int(text) < 2**16):
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, found {text}")
    return int(text)
