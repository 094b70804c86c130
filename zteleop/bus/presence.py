"""Who is there: liveliness tokens that stand for nodes and for what they publish and hear.

    robot/<robot>/live/node/<node>/<process>
    robot/<robot>/live/sender/<sender>                            of commands, in hexadecimal
    robot/<robot>/live/pub/<node>/<process>/<type>/<topic...>    and sub likewise
    robot/<robot>/live/param/<node>/<process>                     what has parameters
    robot/<robot>/live/srv/<node>/<process>/<type>/<service...>

A type's slashes are dots, and one that does not come with zteleop has a hash of its fields behind a `~`; of
several a comma is between. A process is its host and number. Zenoh removes a token with its process.
"""

import os
import re
import socket
from collections.abc import Iterable, Sequence
from typing import Literal, NamedTuple

from zteleop.bus.lag import Lag
from zteleop.bus.names import Name, is_robot
from zteleop.bus.session import Sample, Session
from zteleop.control.settings import SOURCES
from zteleop.errors import nearest
from zteleop.messages import MESSAGES, Message

Kind = Literal["pub", "sub"]
ANY = "any"
"""the type of who hears all"""
RECORDER = "blackbox"
"""the node that hears whatever is said of its robot, and is nobody to whom it is said"""
DEPARTURES = 100
PUBLICATIONS = 1000
ROBOTS = 1000
TYPES = 10
"""of one node on one topic that are remembered: anybody may declare anything"""
_ACTUATORS = "robot/*/live/node/actuator/*"


class Endpoint(NamedTuple):
    """One node's part in one topic, with one of the types that it says or hears there."""

    robot: str
    kind: str
    node: str
    process: str
    type: str
    topic: str
    hash: str = ""
    """of the type's fields, where the type does not come with zteleop"""


def process() -> str:
    """Return this process by its host and number, as one part of a key."""
    host = re.sub(r"[^A-Za-z0-9_-]", "-", socket.gethostname())[:32]
    return f"{host}-{os.getpid()}"


def node_key(robot: str, node: str) -> str:
    return f"robot/{robot}/live/node/{node}/{process()}"


def sender_key(robot: str, sender: int, node: str) -> str:
    return f"robot/{robot}/live/sender/{sender:x}/{node}/{process()}"


class Departures:
    """An inbox of the senders of commands that left, or whose process ended."""

    def __init__(self, session: Session, robot: str) -> None:
        self.ring = session.watch_tokens(f"robot/{robot}/live/sender/**", DEPARTURES)
        self.lag = Lag()

    def read(self, sample: Sample) -> int | None:
        """Return the sender whose token is gone; None for one that came."""
        parts = sample.key.split("/", 5)
        name = parts[4] if len(parts) > 4 else ""
        left = not sample.is_put and 0 < len(name) <= 16
        return int(name, 16) if left and set(name) <= set("0123456789abcdef") else None


class Publications:
    """The paths on which nodes of one robot say that they publish; anybody may say anything."""

    def __init__(self, session: Session, robot: str) -> None:
        self._ring = session.watch_tokens(f"robot/{robot}/live/pub/**", PUBLICATIONS, history=True)
        self._tokens: dict[str, str] = {}

    def changes(self) -> tuple[set[str], set[str]]:
        """Return the paths that have come since the last call, and those that have gone."""
        before = set(self._tokens.values())
        while (sample := self._ring.try_recv()) is not None:
            key = sample.key
            if not sample.is_put:
                self._tokens.pop(key, None)
            elif len(self._tokens) < PUBLICATIONS and (path := _path(key)):
                self._tokens[key] = path
        now = set(self._tokens.values())
        return now - before, before - now


class Tokens:
    """The keys of tokens, as they come and go; of more than `most` the first."""

    def __init__(self, session: Session, selector: str, most: int) -> None:
        self._ring = session.watch_tokens(selector, most, history=True)
        self._most = most
        self._keys: set[str] = set()

    def there(self) -> set[str]:
        """Return those that are there now."""
        while (sample := self._ring.try_recv()) is not None:
            if not sample.is_put:
                self._keys.discard(sample.key)
            elif len(self._keys) < self._most:
                self._keys.add(sample.key)
        return self._keys


class Robots:
    """The robots that have an actuator, as they come and go."""

    def __init__(self, session: Session) -> None:
        self._tokens = Tokens(session, _ACTUATORS, ROBOTS)

    def there(self) -> list[str]:
        """Return those that are there now."""
        return _robots_of(self._tokens.there())


def _path(key: str) -> str | None:
    parts = key.split("/", 7)
    return parts[7] if len(parts) == 8 and key.isprintable() and not set("*+") & set(key) else None


def endpoint_key(name: Name, kind: Kind, node: str, types: Iterable[type[Message]]) -> str:
    told = ",".join("~".join(filter(None, type_of(one))).replace("/", ".") for one in types) or ANY
    return f"robot/{name.robot}/live/{kind}/{node}/{process()}/{told}/{name.path.replace('*', '+')}"


def type_of(kind: type[Message]) -> tuple[str, str]:
    """Return a ROS type, and the hash of its fields where it does not come with zteleop."""
    if kind.ros_type in MESSAGES:
        return kind.ros_type, ""
    from zteleop.interfaces.schema import fingerprint  # only for a type of one's own

    return kind.ros_type, fingerprint(kind)


def endpoints(session: Session) -> list[Endpoint]:
    """Return what every robot's nodes publish and hear, as all who are connected tell."""
    return everybody(session).endpoints


def service_key(name: Name, node: str, ros_type: str) -> str:
    return f"robot/{name.robot}/live/srv/{node}/{process()}/{ros_type.replace('/', '.')}/{name.path}"


class Everybody(NamedTuple):
    """All that tokens stand for."""

    endpoints: list[Endpoint]
    nodes: list["Member"]
    services: list[Endpoint]
    with_parameters: list["Member"]


def everybody(session: Session) -> Everybody:
    """Return all of it, by one question: of several, each would wait for whoever does not answer."""
    keys = _tokens(session, "robot/*/live/**")
    return Everybody(
        _endpoints_in(keys, "pub", "sub"),
        _members_in(keys, "node"),
        _endpoints_in(keys, "srv"),
        _members_in(keys, "param"),
    )


def parameters_key(robot: str, node: str) -> str:
    return f"robot/{robot}/live/param/{node}/{process()}"


def with_parameters(session: Session) -> list["Member"]:
    """Return every robot's nodes that have parameters."""
    return _members(session, "param")


def services(session: Session) -> list[Endpoint]:
    """Return what every robot's nodes answer."""
    return _endpoints(session, "srv")


class Member(NamedTuple):
    """One process that runs a node."""

    robot: str
    node: str
    process: str


def nodes(session: Session) -> list[Member]:
    """Return every robot's nodes, also those that publish and hear nothing."""
    return _members(session, "node")


def holders(session: Session, robot: str, node: str) -> list[str]:
    """Return the processes that run a node of that name for a robot."""
    return sorted(key.rpartition("/")[2] for key in _tokens(session, f"robot/{robot}/live/node/{node}/*"))


def rivals(session: Session, robot: str, node: str, before: Iterable[str]) -> list[str]:
    """Return who goes first of those that run a node: who did before, and of several at once the lesser."""
    return sorted({*before, *(holder for holder in holders(session, robot, node) if holder < process())})


def senders(session: Session, robot: str) -> dict[str, Member]:
    """Return which node each sender of commands is, by its hexadecimal digits."""
    keys = (key.split("/") for key in _tokens(session, f"robot/{robot}/live/sender/*/*/*"))
    return {parts[4]: Member(robot, parts[5], parts[6]) for parts in keys if len(parts) == 7}


def robots(session: Session) -> list[str]:
    """Return the robots that have an actuator."""
    return _robots_of(_tokens(session, _ACTUATORS))


def _robots_of(keys: Iterable[str]) -> list[str]:
    return sorted({robot for key in keys if is_robot(robot := key.split("/")[1])})


def _members(session: Session, kind: str) -> list[Member]:
    return _members_in(_tokens(session, f"robot/*/live/{kind}/*/*"), kind)


def _members_in(keys: Iterable[str], kind: str) -> list[Member]:
    parts = (key.split("/") for key in keys)
    found = (part for part in parts if len(part) == 6 and part[3] == kind)
    return sorted(Member(robot, node, where) for _, robot, _, _, node, where in found)


def _endpoints(session: Session, kind: str) -> list[Endpoint]:
    return _endpoints_in(_tokens(session, f"robot/*/live/{kind}/**"), kind)


def _endpoints_in(keys: Iterable[str], *kinds: str) -> list[Endpoint]:
    wanted = [f"/live/{kind}/" for kind in kinds]
    found = {one for key in keys if any(part in key for part in wanted) for one in endpoints_of(key)}
    return sorted(one for one in found if one.kind in kinds)


def endpoints_of(key: str) -> list[Endpoint]:
    """Return what a token stands for, once for each type; nothing where it is no node's part in a topic."""
    parts = key.split("/", 7)
    if len(parts) < 8 or not key.isprintable():
        return []
    _, robot, _, kind, node, where, types, topic = parts
    apart = (ros_type.replace(".", "/").partition("~") for ros_type in types.split(",")[:TYPES])
    topic = topic.replace("+", "*")
    return [Endpoint(robot, kind, node, where, ros_type, topic, digest) for ros_type, _, digest in apart]


def _tokens(session: Session, selector: str) -> set[str]:
    """Return the keys of the tokens there are; anybody may declare anything, also for every robot at once."""
    return {key for key in session.tokens(selector) if key.isprintable() and "*" not in key}


def unknown_source(session: Session, name: Name) -> str:
    """Say of a command topic that its robot has no such source, if so: it hears each of its own by name."""
    topic, _, source = name.path.partition("/")
    if source in SOURCES:
        return ""
    heard = {
        one.topic
        for one in endpoints(session)
        if (one.robot, one.kind, one.node) == (name.robot, "sub", "actuator")
    }
    known = sorted(path.partition("/")[2] for path in heard if path.startswith(f"{topic}/"))
    if not source or not known or source in known:
        return ""
    return (
        f"robot {name.robot} has no source {source!r}; {nearest(source, known)}; "
        f"[drive.sources.{source}] in its config.toml adds one"
    )


def here(session: Session, wanted: str | None) -> str:
    """Return which robots have an actuator that is heard, where the one that is wanted has none."""
    return who_is_here(robots(session), wanted or "", session.unreached())


def who_is_here(there: Iterable[str], wanted: str = "", unreached: Sequence[str] = ()) -> str:
    """Return which robots could have been meant, where the one that is wanted is not heard."""
    from difflib import get_close_matches

    found = sorted(set(there))
    if not found and unreached:
        return f"nothing answers at {', '.join(unreached)}: is the address right, and the robot on?"
    if not found:
        return "no actuator is heard here"
    near = get_close_matches(wanted, found, 1)
    return f"heard here: {', '.join(found)}" + (f"; did you mean {near[0]}?" if near else "")
