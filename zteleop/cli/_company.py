"""Who speaks and who hears on the bus, in words for whoever waits for them."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from zteleop.bus import presence
from zteleop.bus.hearers import told_apart
from zteleop.bus.names import Name
from zteleop.bus.presence import Endpoint, Kind, process, who_is_here
from zteleop.bus.topics import TOPICS, topic_of
from zteleop.errors import meant, nearest

TOLD_BY = {
    "stop": "; it is said only when somebody stops a robot: zteleop why tells which stops are in force",
}
"""topics that are said seldom -> who tells what was said"""
SAID_BY = {"odom": "; zteleop sim says it of a simulated robot, zteleop odometry of any other"}
"""topics that somebody else says than the actuator -> who does"""


def by_topic(endpoints: Iterable[Endpoint]) -> dict[str, list[Endpoint]]:
    """Group by topic; a command topic's sources are one."""
    found: dict[str, list[Endpoint]] = {}
    for endpoint in endpoints:
        found.setdefault(f"/{endpoint.robot}/{topic_of(endpoint.topic).name}", []).append(endpoint)
    return dict(sorted(found.items()))


def members(name: Name, kind: Kind, endpoints: Iterable[Endpoint]) -> list[Endpoint]:
    """Return who publishes a topic, or who hears it."""
    return [one for one in endpoints if (one.robot, one.kind) == (name.robot, kind) and meets(name, one)]


def meets(name: Name, one: Endpoint) -> bool:
    """Say whether an endpoint is of a topic: of a command's plain name all sources are, else that one."""
    topic = topic_of(name.path).name
    if topic_of(one.topic).name != topic:
        return False
    return name.path in (topic, one.topic) or one.topic in (topic, f"{topic}/**")


def disagreements(members: Iterable[Endpoint]) -> Iterator[str]:
    """Yield who says on a topic what somebody does not hear: another type, or one with other fields."""
    members = [one for one in members if one.type != presence.ANY and not topic_of(one.topic).types]
    speakers = {(one.node, one.process, one.type, one.hash) for one in members if one.kind == "pub"}
    hearers = {(one.node, one.process, one.type, one.hash) for one in members if one.kind == "sub"}
    agreed = True
    for node, where, ros_type, digest in sorted(speakers):
        for ear, there, wanted, its in sorted(hearers):
            if (ear, there, ros_type, digest) not in hearers:
                agreed = False
                said, heard = told_apart((ros_type, digest), (wanted, its))
                yield f"{node} on {where} says {said}; {ear} on {there} hears {heard} alone, and drops it"
    for one, other in combinations(sorted(speakers), 2) if agreed else ():
        if one[:2] != other[:2] and one[2:] != other[2:]:
            said, otherwise = told_apart(one[2:], other[2:])
            yield f"{one[0]} on {one[1]} says {said}; {other[0]} on {other[1]} says {otherwise}"


def why_silent(name: Name, endpoints: Iterable[Endpoint], unreached: Sequence[str] = ()) -> str:
    """Return who says nothing on a topic, or which topic may have been meant."""
    endpoints = list(endpoints)
    told = TOLD_BY.get(name.path, "")
    if speakers := members(name, "pub", endpoints):
        return (
            f"{_people(speakers)} {_verb('publish', speakers)} it, and says nothing now"
            f"{_instead(name, speakers, endpoints)}{told}"
        )
    return f"nobody publishes it{_others(name, 'pub', endpoints, unreached)}{told}"


def who_hears(name: Name, endpoints: Iterable[Endpoint], unreached: Sequence[str] = ()) -> str:
    """Return who hears a topic, or which topic may have been meant."""
    endpoints = list(endpoints)
    if hearers := members(name, "sub", endpoints):
        return f"{_people(hearers)} {_verb('hear', hearers)} it"
    return f"nobody hears it{_others(name, 'sub', endpoints, unreached)}"


def _instead(name: Name, speakers: list[Endpoint], endpoints: list[Endpoint]) -> str:
    """Say on which other command topic whoever is silent on one may speak: a keyboard in steps, on pwm."""
    own = topic_of(name.path)
    theirs = {(one.robot, one.process) for one in speakers}
    said = {
        topic_of(one.topic) for one in endpoints if one.kind == "pub" and (one.robot, one.process) in theirs
    }
    others = sorted(topic.name for topic in said - {own} if own.command and topic.command)
    return f"; while somebody drives, it may speak on {' or '.join(others)} instead" if others else ""


def _others(name: Name, kind: Kind, endpoints: list[Endpoint], unreached: Sequence[str]) -> str:
    others = [one for one in endpoints if one.process != process()]
    robots = {one.robot for one in others if one.kind == "pub"}
    if name.robot not in robots:
        return f"; robot {name.robot} is not heard; {who_is_here(robots, name.robot, unreached)}"
    topics = {topic_of(one.topic).name for one in others if (one.robot, one.kind) == (name.robot, kind)}
    if topic_of(name.path).types or not topics:
        return f" now{SAID_BY.get(name.path, '') if kind == 'pub' else ''}"
    if question := meant(name.path, topics | TOPICS.keys()):
        return f"; {question}"
    # Whoever hears a topic of somebody's own is yet to come; whoever waits for one is told what there is.
    return " now" if kind == "sub" else f"; {nearest(name.path, topics)}"


def _people(endpoints: Iterable[Endpoint]) -> str:
    return " and ".join(sorted({f"{one.node} on {one.process}" for one in endpoints}))


def _verb(plain: str, endpoints: list[Endpoint]) -> str:
    several = len({(one.node, one.process) for one in endpoints}) > 1
    return plain if several else plain + ("es" if plain.endswith("sh") else "s")
