"""What a stranger on the bus may say: each target takes any bytes, and returns unless it found a fault."""

import argparse
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import zenoh
from fuzz.reading import ALL, is_key, parts, safe

from zteleop.bus import codec, presence
from zteleop.bus.escape import printable
from zteleop.bus.names import chunk, resolve, robot_name
from zteleop.bus.session import Sample
from zteleop.bus.settings import BusSettings
from zteleop.bus.zenoh_open import _check_threads, _configure
from zteleop.cli import echo
from zteleop.control.deadlines import Deadlines
from zteleop.control.gate import Gate
from zteleop.errors import ConfigError, MessageError
from zteleop.messages import Message
from zteleop.terminal.cells import printable as shown

EPOCH = 7 << 50
LOOKS = (
    *(
        (),
        ("--json",),
        ("--csv", "--header"),
        ("--raw",),
        ("--flow-style", "--no-arr", "--no-str"),
        ("Twist",),
    ),
    *(("--field", "linear.x", "--field", "data[0]"), ("--filter", "m.linear.x + m.data[0] > 0", "-f")),
)


def wanted(look: tuple[str, ...]) -> echo.Wanted:
    """Return what somebody wants to see who types these words behind a topic."""
    parser = argparse.ArgumentParser()
    echo.add_arguments(parser)
    return echo.Wanted(parser.parse_args(["odom", *look]))


WANTED = [partial(wanted, look) for look in LOOKS]


def message(data: bytes) -> None:
    """Read a message, its encoding in the first line, as a node does and as a person who looks at it."""
    encoding, payload = parts(data)
    found = None
    with suppress(MessageError):
        found = codec.decode(payload, encoding, ALL)
        assert isinstance(found, Message)
    assert found is None or codec.decode(codec.encode(found), encoding, ALL) == found
    for wanted in WANTED:
        with suppress(MessageError):
            safe(wanted().text(Sample("robot/bench/odom", payload, encoding)) or "")


def proof(data: bytes) -> None:
    """Judge what attachments prove, the length of each before it."""
    gate, now = Gate(Deadlines(), EPOCH, 100.0), 100.0
    while data:
        length, data = data[0], data[1:]
        attachment, data, now = data[:length], data[length:], now + 0.05
        found = codec.unpack_proof(attachment)
        assert (found is None) == (len(attachment) != 48)
        for moving in (True, False):
            refusal = gate.judge(found, moving, now)
            assert refusal or (found and found.epoch == EPOCH and 0 <= now - found.beat <= 0.3)
            assert refusal or not moving or (found and 100 < found.began <= found.acted <= now)


def names(data: bytes) -> None:
    """Take any text for the name of a robot, of a topic or of a source."""
    text = data.decode("utf-8", "surrogateescape")
    for read in (robot_name, lambda name: chunk(name, "a node's name"), *resolvers()):
        try:
            found = read(text)
        except ConfigError as error:
            safe(printable(str(error)))
            continue
        key = getattr(found, "key", None) or f"robot/{found}"
        assert str(zenoh.KeyExpr(key)) == key
        assert not {*"*$#?"} & {*key}


def resolvers() -> list[Callable[[str], Any]]:
    return [lambda text: resolve(text, None), lambda text: resolve(text, "archangel")]


def token(data: bytes) -> None:
    """Read keys of liveliness tokens, a line each, as a listing and as an actuator do."""
    found = data.decode("utf-8", "replace").split("\n")
    session: Any = Tokens([f"robot/{key}" for key in found if is_key(f"robot/{key}")])
    departures = presence.Departures(session, "archangel")
    for name in (*presence.robots(session), *presence.holders(session, "archangel", "actuator")):
        safe(name)
    for endpoint in presence.endpoints(session):
        safe("".join(endpoint))
    for name in presence.robots(session):
        assert robot_name(name)
    for key in session.keys:
        sender = departures.read(Sample(key, b"", "", is_put=False))
        assert sender is None or 0 <= sender < 2**64


class Tokens:
    """A session that has heard of these tokens."""

    def __init__(self, keys: list[str]) -> None:
        self.keys = keys

    def watch_tokens(self, *_: object) -> None:
        return None

    def tokens(self, selector: str) -> set[str]:
        wanted = zenoh.KeyExpr(selector)
        return {key for key in self.keys if wanted.intersects(zenoh.KeyExpr(key))}


def endpoint(data: bytes) -> None:
    """Take any text for an address on the bus, and for zenoh's threads."""
    text = data.decode("utf-8", "replace")
    for settings in (BusSettings(connect=[text]), BusSettings(listen=[text])):
        with suppress(ConfigError):
            _configure(settings, settle=False)
    with suppress(ConfigError):
        _check_threads(text)


def screen(data: bytes) -> None:
    """Show any text on the keyboard's screen."""
    text = data.decode("utf-8", "replace")
    safe(shown(text))
    assert shown(text, unicode=False).isascii()
