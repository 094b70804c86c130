import argparse

from zteleop.bus import presence
from zteleop.bus.presence import Endpoint
from zteleop.bus.session import open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop list",
    "zteleop list --show-types --verbose",
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
        here = _company.who_is_here(robots, settings.robot or "", unreached)
        start = "start one with: zteleop demo, or zteleop actuator"
        raise BusError(f"nobody speaks for {where}; {here if robots or unreached else start}")
    if arguments.count_topics:
        print(len(_company.by_topic(endpoints)))
        return
    for name, members in _company.by_topic(endpoints).items():
        print(_line(name, members, arguments.show_types))
        if arguments.verbose:
            print("".join(f"    also {alias}\n" for alias in topic_of(name.split("/", 2)[2]).aliases), end="")
            print("\n".join(f"    {m.kind} {m.node} on {m.process}: {m.topic} [{m.type}]" for m in members))


def _line(name: str, members: list[Endpoint], show_types: bool) -> str:
    types = sorted({member.type for member in members})
    return f"{name} [{', '.join(types)}]" if show_types else name
