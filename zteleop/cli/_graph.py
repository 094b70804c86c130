"""Who is on the bus, as all who are connected tell; and words for whoever asks for one who is not."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from zteleop.bus import presence
from zteleop.bus.names import Name, resolve
from zteleop.bus.presence import Endpoint, Member
from zteleop.bus.session import open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.errors import BusError, nearest


class Graph(NamedTuple):
    """What every robot's nodes publish and hear, and the robot that was meant where none is said."""

    endpoints: list[Endpoint]
    nodes: list[Member]
    robot: str | None

    def topic(self, text: str) -> tuple[Name, list[Endpoint]]:
        """Return a topic and who publishes or hears it; raises BusError when nobody does."""
        name = resolve(text, self.robot)
        topic = topic_of(name.path).name
        found = [
            one for one in self.endpoints if (one.robot, topic_of(one.topic).name) == (name.robot, topic)
        ]
        if not found:
            raise BusError(f"Unknown topic '/{name}'; {self._instead(name)}")
        return name, found

    def _instead(self, name: Name) -> str:
        """Return what somebody may have meant who asked for a topic that nobody has."""
        robots = {one.robot for one in self.endpoints}
        if name.robot not in robots:
            return f"robot {name.robot} is not heard; {_company.who_is_here(robots, name.robot)}"
        if topic_of(name.path).types:
            return "nobody publishes it, or hears it, yet"
        return nearest(
            name.path, {topic_of(one.topic).name for one in self.endpoints if one.robot == name.robot}
        )

    def nobody(self, robot: str | None) -> str:
        """Return what to tell whoever finds nobody, or not the robot he means."""
        robots = {one.robot for one in self.nodes}
        if robot and robots:
            return f"robot {robot} is not heard; {_company.who_is_here(robots, robot)}"
        return "nobody is on the bus; start one with: zteleop demo, or zteleop actuator"

    def topics(self) -> dict[str, list[Endpoint]]:
        """Return all topics as /robot/topic, and their endpoints."""
        return _company.by_topic(self.endpoints)


def types_of(members: list[Endpoint]) -> list[str]:
    """Return the types that a topic carries, those first that it is made for."""
    made_for = [kind.ros_type for kind in topic_of(members[0].topic).types]
    told = {member.type for member in members} - {"any"}
    return [*made_for, *sorted(told.difference(made_for))] or ["any"]


@contextmanager
def graph(arguments: argparse.Namespace) -> Iterator[Graph]:
    """Join the bus until everybody has told what there is."""
    settings = _options.load(arguments)
    with open_session(settings.bus, settle=True) as session:
        robots = presence.robots(session)
        robot = settings.robot or (robots[0] if len(robots) == 1 else None)
        yield Graph(presence.endpoints(session), presence.nodes(session), robot)
