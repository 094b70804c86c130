"""Who is on the bus, as all who are connected tell; and words for whoever asks for one who is not."""

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from zteleop.bus import presence, times
from zteleop.bus.names import Name, resolve
from zteleop.bus.parameters import SERVICES as PARAMETER_SERVICES
from zteleop.bus.presence import Endpoint, Member
from zteleop.bus.session import Session, open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.errors import BusError, meant, nearest


class Graph(NamedTuple):
    """What every robot's nodes publish, hear and answer, and the robot that was meant where none is said."""

    endpoints: list[Endpoint]
    nodes: list[Member]
    robot: str | None
    services: list[Endpoint] = []
    with_parameters: list[Member] = []
    unreached: Sequence[str] = ()
    """endpoints at which nobody answers, where nobody does at any"""

    def topic(self, text: str) -> tuple[Name, list[Endpoint]]:
        """Return a topic and who publishes or hears it; raises BusError for none, or several robots'."""
        name = resolve(text, self.robot or self._only_robot_of(text))
        found = [one for one in self.endpoints if one.robot == name.robot and _company.meets(name, one)]
        if not found:
            raise BusError(f"Unknown topic '/{name}'; {self._instead(name)}")
        return name, found

    def _only_robot_of(self, text: str) -> str | None:
        """Return the robot that has a topic typed without one; raises BusError where several have it."""
        wanted = topic_of(text.strip("/")).name
        found = sorted({one.robot for one in self.endpoints if topic_of(one.topic).name == wanted})
        if len(found) > 1:
            raise BusError(
                f"several have '{text}': {', '.join(f'/{one}/{wanted}' for one in found)}; say which"
            )
        return found[0] if found else None

    def service(self, text: str) -> tuple[Name, list[Endpoint]]:
        """Return a service and who answers it; raises BusError when nobody does, or several robots do.

        Whoever writes no robot means the one selected, or the only one that serves it.
        """
        wanted = text.strip("/")
        known = {Name(one.robot, one.topic) for one in self.all_services}
        found = {name for name in known if wanted in (str(name), name.path)}
        own = {name for name in found if name == (self.robot, wanted)} or found
        if len(own) > 1:
            raise BusError(
                f"several serve '{text}': {', '.join(f'/{name}' for name in sorted(own))}; say which"
            )
        if not own:
            near = meant(f"/{wanted}", (f"/{name}" for name in known))
            named = nearest(f"/{wanted}", (f"/{name}" for name in self._named)) if self._named else ""
            near = near or named or "there is none here"
            raise BusError(f"Unknown service '{text}'; {near}")
        (name,) = own
        return name, [one for one in self.all_services if (one.robot, one.topic) == name]

    @property
    def _named(self) -> set[Name]:
        """The services that are more than every node's own."""
        return {Name(one.robot, one.topic) for one in self.services}

    @property
    def all_services(self) -> list[Endpoint]:
        """Also those that every node has."""
        return [*self.services, *(one for node in self.with_parameters for one in node_services(node))]

    def _instead(self, name: Name) -> str:
        """Return what somebody may have meant who asked for a topic that nobody has."""
        robots = {one.robot for one in self.endpoints}
        if name.robot not in robots:
            return (
                f"robot {name.robot} is not heard; {presence.who_is_here(robots, name.robot, self.unreached)}"
            )
        if topic_of(name.path).types:
            return "nobody publishes it, or hears it, yet"
        return nearest(
            name.path, {topic_of(one.topic).name for one in self.endpoints if one.robot == name.robot}
        )

    def nobody(self, robot: str | None) -> str:
        """Return what to tell whoever finds nobody, or not the robot he means."""
        robots = {one.robot for one in self.nodes}
        if robot and robots:
            return f"robot {robot} is not heard; {presence.who_is_here(robots, robot)}"
        if self.unreached:
            return f"nobody is on the bus; {presence.who_is_here((), '', self.unreached)}"
        return "nobody is on the bus; start one with: zteleop demo, or zteleop actuator"

    def topics(self) -> dict[str, list[Endpoint]]:
        """Return all topics as /robot/topic, and their endpoints."""
        return _company.by_topic(self.endpoints)


def node_services(node: Member) -> list[Endpoint]:
    """Return what every node answers: what its parameters are, and what time it has."""
    return [
        Endpoint(node.robot, "srv", node.node, node.process, ros_type, f"{node.node}/{name}")
        for name, ros_type in {**PARAMETER_SERVICES, times.SERVICE: times.TYPE}.items()
    ]


def types_of(members: list[Endpoint]) -> list[str]:
    """Return the types that a topic carries, those first that it is made for."""
    made_for = [kind.ros_type for kind in topic_of(members[0].topic).types]
    told = {member.type for member in members} - {"any"}
    return [*made_for, *sorted(told.difference(made_for))] or ["any"]


def find_node(text: str, members: Sequence[Member], robot: str | None) -> tuple[str, str]:
    """Return robot and name of a node that somebody typed; raises BusError for one that is not there."""
    known = sorted({f"/{node.robot}/{node.node}" for node in members})
    named = text.strip("/")
    wanted = [one for one in known if one == f"/{named}" or ("/" not in named and one.endswith(f"/{named}"))]
    own = [one for one in wanted if one == f"/{robot}/{named}"] or wanted
    if len(own) > 1:
        raise BusError(f"{len(own)} nodes are called {named}: {', '.join(own)}; say which")
    if not own:
        raise BusError(f"Unable to find node '{text}'; {nearest(f'/{named}', known)}")
    _, found, node = own[0].split("/")
    return found, node


@contextmanager
def graph(arguments: argparse.Namespace) -> Iterator[Graph]:
    """Join the bus until everybody has told what there is."""
    settings = _options.load(arguments)
    with open_session(settings.bus, settle=True) as session:
        yield look(session, settings.robot)


def look(session: Session, selected: str | None) -> Graph:
    """Return who is there now; of the robots the one selected is meant, or the only one."""
    there = presence.everybody(session)
    robots = sorted({node.robot for node in there.nodes if node.node == "actuator"})
    robot = selected or (robots[0] if len(robots) == 1 else None)
    return Graph(
        there.endpoints, there.nodes, robot, there.services, there.with_parameters, session.unreached()
    )
