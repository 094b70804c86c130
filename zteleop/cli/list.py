import argparse
from collections.abc import Iterable, Iterator

from zteleop.bus import presence
from zteleop.bus.presence import Endpoint
from zteleop.bus.session import open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.cli._graph import types_of
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop list",
    "zteleop list --verbose",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="with the type of each topic")
    parser.add_argument("-c", "--count-topics", action="store_true", help="say only how many")
    parser.add_argument("-v", "--verbose", action="store_true", help="with who publishes and who hears it")


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    with open_session(settings.bus, settle=True) as session:
        everybody, unreached = presence.endpoints(session), session.unreached()
    endpoints = [one for one in everybody if settings.robot in (None, one.robot)]
    if not endpoints:
        where = settings.robot or "a robot"
        robots = {one.robot for one in everybody}
        here = presence.who_is_here(robots, settings.robot or "", unreached)
        start = "start one with: zteleop demo, or zteleop actuator"
        raise BusError(f"nobody speaks for {where}; {here if robots or unreached else start}")
    if arguments.count_topics:
        print(len(_company.by_topic(endpoints)))
        return
    if arguments.verbose:
        print("\n".join(_with_people(endpoints)))
        return
    for name, members in _company.by_topic(endpoints).items():
        print(_line(name, members, arguments.show_types))


def _with_people(endpoints: Iterable[Endpoint]) -> Iterator[str]:
    """Yield each topic with who publishes it, and then with who hears it, in the words of ROS."""
    for kind, title, what in (("pub", "Published", "publisher"), ("sub", "Subscribed", "subscriber")):
        yield f"{title} topics:"
        for name, members in _company.by_topic(one for one in endpoints if one.kind == kind).items():
            also = "".join(f", also {alias}" for alias in topic_of(name.split("/", 2)[2]).aliases)
            nodes = len({(one.node, one.process) for one in members})
            yield f" * {_line(name, members, True)} {nodes} {what}{'s'[: nodes - 1]}{also}"
            plain = topic_of(members[0].topic).name
            people = (
                f"     {one.node} on {one.process}{'' if one.topic == plain else f': {one.topic}'}"
                for one in members
            )
            yield from dict.fromkeys(people)  # who says several types says each of them there
        if kind == "pub":
            yield ""


def _line(name: str, members: list[Endpoint], show_types: bool) -> str:
    told = {member.type for member in members}
    types = [one for one in types_of(members) if one in told] or sorted(told)
    return f"{name} [{', '.join(types)}]" if show_types else name
