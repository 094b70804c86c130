"""Who may open a connection: who knows the token, and comes from a page of this very server.

A browser lets any page in the world open a WebSocket to this machine, and says in `Origin` which page it
was; and any name in the world can be made to lead here (DNS rebinding), which `Host` tells.
"""

import hmac
import secrets
from collections.abc import Iterable, Sequence
from ipaddress import ip_address
from urllib.parse import urlsplit

PROTOCOL = "zteleop.v1"
PREFIX = "token."
"""before the token, in the list of subprotocols: the only words of a browser's that are not in an address"""
LOOPBACK = frozenset({"localhost", "127.0.0.1", "::1"})
LONGEST = 200
"""characters of a token that are looked at"""


def new_token() -> str:
    """Return a token of 128 random bits."""
    return secrets.token_urlsafe(16)


class Tickets:
    """Looks at what a browser says before it is let in; `hosts` are other names that lead here.

    Who listens in a network is reached by `addresses` too: no page elsewhere can make a number lead here.
    """

    def __init__(self, token: str, hosts: Iterable[str] = (), addresses: bool = False) -> None:
        self._token = token
        self._hosts = LOOPBACK | {host.lower() for host in hosts}
        self._addresses = addresses

    def refusal(self, host: str, origin: str | None, protocols: Sequence[str]) -> str:
        """Return why a connection is refused, in a sentence; nothing for one that is welcome."""
        if wrong := self.unknown_host(host):
            return wrong
        if origin is not None and authority(origin) != host.lower():
            return f"the page is of {shown(origin)}, and this is {shown(host)}: open the page of this server"
        if PROTOCOL not in protocols:
            return f"expected the subprotocol {PROTOCOL}; load the page anew"
        offered = [one.removeprefix(PREFIX) for one in protocols if one.startswith(PREFIX)]
        if not any(self._is_mine(token[:LONGEST]) for token in offered):
            return "the token is missing or wrong: open the address that zteleop web has printed"
        return ""

    def unknown_host(self, host: str) -> str:
        """Return why a name is refused that leads here; nothing for one that may."""
        name = name_of(host)
        if name in self._hosts or (self._addresses and is_address(name)):
            return ""
        return f"{shown(host)} is no name of this server; where it is one, start it with --host {shown(host)}"

    def _is_mine(self, token: str) -> bool:
        return hmac.compare_digest(token.encode(), self._token.encode())


def authority(origin: str) -> str:
    """Return host and port of an Origin, as Host says them; empty where there is none."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return ""


def name_of(host: str) -> str:
    """Return the name of a Host, without its port."""
    try:
        return (urlsplit(f"//{host}").hostname or "").lower()
    except ValueError:
        return ""


def is_address(name: str) -> bool:
    """Say whether a name is a number of a machine, which nobody looks up."""
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


def shown(text: str) -> str:
    """Return what a stranger said, short enough to be told."""
    return text if len(text) <= 60 else f"{text[:60]}..."
