"""By which address others open a page, and what keeps it from being read along."""

import socket
import ssl
from contextlib import closing
from ipaddress import ip_address

from zteleop.errors import ConfigError

EVERYWHERE = ("", "0.0.0.0", "::")
"""what a server listens at to be reached by every network of this machine"""
ELSEWHERE = ("192.0.2.1", 9)
"""an address that is nobody's (RFC 5737): the way there is the way into the network"""


def is_loopback(listen: str) -> bool:
    """Say whether nobody but this machine reaches a server that listens there."""
    try:
        return ip_address(listen).is_loopback
    except ValueError:
        return listen == "localhost"


def reached_at(listen: str) -> str:
    """Return by which address others reach a server that listens there, as it stands in a page's address."""
    found = _into_the_network() if listen in EVERYWHERE else listen
    return f"[{found}]" if ":" in found else found


def _into_the_network() -> str:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as asked:
        try:
            asked.connect(ELSEWHERE)  # which sends nothing
        except OSError:
            return "127.0.0.1"  # it is in no network
        return str(asked.getsockname()[0])


def security(certificate: str, key: str) -> ssl.SSLContext:
    """Return what TLS is spoken with; the key may be in the certificate's file.

    Raises ConfigError for files that are none, or do not belong together.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    try:
        context.load_cert_chain(certificate, key or None, password=_refuse)
    except (OSError, ValueError) as error:  # an SSLError is an OSError
        files = f"{certificate} and {key}" if key else f"{certificate}, with its key,"
        reason = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        raise ConfigError(
            f"expected {files} as PEM files that belong together, found: {reason}; docs/phone.md makes a pair"
        ) from None
    return context


def _refuse() -> str:
    raise ValueError("the key wants a password, and nobody can be asked for it")
