"""Where pages are served that drive a robot, how they are reached, and who is told so."""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple

from zteleop.errors import ConfigError, DeviceError, install

if TYPE_CHECKING:
    from zteleop.bridges.web.server import Cockpit

HERE, PORT = "127.0.0.1", 8765
"""where pages are served: on this machine alone"""


class Place(NamedTuple):
    """Where pages are served, and how they are reached."""

    at: str = HERE
    port: int = PORT
    hosts: Sequence[str] = ()
    """other names that lead here"""
    certificate: str = ""
    key: str = ""


def add(parser: argparse.ArgumentParser) -> None:
    of = f"0 is any that is free (default: {PORT})"
    parser.add_argument("--port", type=port, default=PORT, metavar="N", help=of)
    at = f"0.0.0.0 is every network of this machine (default: {HERE}, this machine alone)"
    parser.add_argument("--serve-at", default=HERE, metavar="ADDRESS", help=at)
    parser.add_argument(
        "--host",
        metavar="NAME",
        action="append",
        default=[],
        help="another name by which a browser reaches this server, as that of a tunnel; may be repeated",
    )
    parser.add_argument("--tls-cert", metavar="FILE", default="", help="speak https, with this certificate")
    parser.add_argument("--tls-key", metavar="FILE", default="", help="its key, where that is another file")


def place_of(arguments: argparse.Namespace) -> Place:
    """Return the place that was typed.

    Raises ConfigError for one that cannot be, DeviceError where what serves a page is not installed.
    """
    expect_websockets()
    place = _typed(arguments)
    if place.key and not place.certificate:
        raise ConfigError("a key alone is no identity: say --tls-cert as well")
    return place


def is_typed(arguments: argparse.Namespace) -> bool:
    """Say whether somebody typed where pages are to be served."""
    return _typed(arguments) != Place()


def _typed(arguments: argparse.Namespace) -> Place:
    return Place(
        at=arguments.serve_at,
        port=arguments.port,
        hosts=tuple(arguments.host),
        certificate=arguments.tls_cert,
        key=arguments.tls_key,
    )


def expect_websockets() -> None:
    """Raise DeviceError where what serves a page is not installed."""
    if find_spec("websockets") is None:
        raise DeviceError(f"a page needs websockets, which is not installed; say: {install('web')}")


@contextmanager
def served(
    cockpit: "Cockpit", place: Place, does: str, tell: Callable[[str], object], index: str = "index.html"
) -> Iterator[None]:
    """Serve pages for as long as a `with` lasts, and print their address and what one `does`.

    Raises BusError where the port is taken, ConfigError for a certificate that is none.
    """
    from zteleop.bridges.web.address import is_loopback, reached_at, security
    from zteleop.bridges.web.server import Server
    from zteleop.bridges.web.serving import serving
    from zteleop.bridges.web.tickets import Tickets, new_token

    token, alone = new_token(), is_loopback(place.at)
    secure = security(place.certificate, place.key) if place.certificate else None
    server = Server(Tickets(token, place.hosts, addresses=not alone), cockpit, tell, index)
    with serving(server, place.at, place.port, secure) as where:
        address = f"{'https' if secure else 'http'}://{reached_at(place.at)}:{where}/#t={token}"
        print(f"open {address}", flush=True)
        print(f"it {does}, for whoever knows this address; Ctrl-C ends it", flush=True)
        if not alone:
            _tell_the_room(address, is_secure=secure is not None)
        yield


def _tell_the_room(address: str, is_secure: bool) -> None:
    """Show an address to a phone's camera, and say who else may read it."""
    if sys.stdout.isatty() and find_spec("segno"):
        import segno

        segno.make(address, error="l").terminal(compact=True, border=2)
    if not is_secure:
        words = "whoever shares this network can read the address along; --tls-cert keeps it secret"
        print(f"zteleop: {words}", file=sys.stderr, flush=True)


def port(text: str) -> int:
    """Return a port, as typed."""
    if not (text.isdecimal() and len(text) <= 5 and int(text) < 2**16):
        raise argparse.ArgumentTypeError(f"expected a port from 0 to 65535, found {text}")
    return int(text)
