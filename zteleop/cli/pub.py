import argparse
import os
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import TypeVar

import msgspec

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.loop import FAR
from zteleop.bus.names import Name, resolve
from zteleop.bus.node import Node
from zteleop.bus.presence import Endpoint
from zteleop.bus.publisher import Publisher
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.cli._draft import Draft
from zteleop.cli._outcome import HEARD_WITHIN, TELL_AFTER, Outcome, await_robot
from zteleop.cli._pace import Pace
from zteleop.cli._types import find_type
from zteleop.control.command import steers_only, to_command
from zteleop.control.resume import Resume
from zteleop.control.settings import SOURCES
from zteleop.errors import BusError, ConfigError, MessageError
from zteleop.messages import DriveStatus, Message
from zteleop.text.documents import Documents

M = TypeVar("M", bound=Message)
EXAMPLES = (
    "zteleop pub cmd_vel Twist '{linear: {x: 0.2}}' --rate 10",
    "zteleop pub cmd_vel TwistStamped '{header: auto, twist: {linear: {x: 0.2}}}' --rate 10 --for 1s",
    "zteleop pub archangel/cmd_vel Twist '{linear: {x: 0.3}, angular: {z: 0.5}}' --rate 10 --times 20",
)
SETTLE = 0.1
"""s in which others who hear it are found"""
OBEYED_FOR = SOURCES["program"].silence
"""s after a last command in which its robot still obeys, unless whoever said it leaves"""
STAYS = OBEYED_FOR - 0.04
"""s after it that this stays: who lets go has ended, and whose silence a robot notices is lost"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/cmd_vel")
    parser.add_argument("type", help="such as geometry_msgs/msg/Twist, or Twist")
    parser.add_argument(
        "values", nargs="?", default="{}", help="YAML: '{linear: {x: 0.2}}'; the rest is 0; stamp: now"
    )
    parser.add_argument("-r", "--rate", metavar="HZ", type=_options.rate_hz, default=1.0, help="default: 1")
    parser.add_argument("-1", "--once", action="store_true", help="say it once and end")
    parser.add_argument("--for", metavar="TIME", dest="lasts", type=_options.seconds, help="end after 2s")
    parser.add_argument(
        "--stdin", action="store_true", help="say each YAML document, or line of JSON, that comes"
    )
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        metavar="N",
        type=int,
        help="wait until so many hear it (without this 3 s for one); of a command for its robot",
    )
    parser.add_argument("-t", "--times", metavar="N", type=_options.count, help="say it N times and end")
    parser.add_argument(
        "--resume",
        action="store_true",
        help="drive on by itself after the robot was restarted or the link was long lost; never after a stop",
    )


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    kind = find_type(arguments.type, settings.bus)
    draft = Draft(kind, arguments.values)
    times = 1 if arguments.once else arguments.times
    robot = _options.robot_of(arguments.topic, settings, arguments.robot)
    # A late command is worse than none; whatever else is said so many times is to be heard so often.
    patient = times is not None and not _is_command(arguments.topic, robot)
    with _options.join("pub", msgspec.structs.replace(settings, robot=robot), patient) as node:
        name = resolve(arguments.topic, node.robot)
        publisher = node.publisher(f"/{name}", kind, wait=False)
        command = topic_of(name.path).command
        if command and not arguments.stdin:
            to_command(draft.make())  # what commands nothing is not said at all
        # Before anything is said: what reads a type for the first time may swallow a Ctrl-C that comes then.
        outcome = Outcome("pub", node, publisher) if command else None
        asked = arguments.wait_matching_subscriptions
        wanted = 1 if asked is None else asked
        heard = (
            await_robot("pub", node, publisher)
            if command
            else _await_hearer(node, publisher, name, wanted, HEARD_WITHIN if asked is None else FAR)
        )
        if command and (words := presence.unknown_source(node.membership.session, name)):
            raise BusError(words)
        if not heard and times is None:
            print("zteleop pub: waits no longer, and says it all the same", file=sys.stderr)
        if arguments.stdin:
            _say_what_comes(node, publisher, kind, outcome)
            return
        drives = command and not steers_only(draft.make(), node.membership.heard().vehicle)
        if drives and not times and arguments.rate < 1 / OBEYED_FOR:
            words = f"a robot obeys each for {OBEYED_FOR:g} s, and stops in between; --rate 10 drives on"
            print(f"zteleop pub: {words}", file=sys.stderr)
        resume = Resume(publisher.sender) if arguments.resume and publisher.sender else None
        stay = STAYS if command else 0.0
        _say(node, publisher, draft.make, arguments.rate, times, resume, stay, outcome, arguments.lasts)
        if times is not None and wanted > 0 and not (heard or _hears(node, publisher, name)):
            raise BusError(f"said to nobody: {_who_hears(node, name)}")


def _say(
    node: Node,
    publisher: Publisher[Message],
    make: Callable[[], Message],
    rate: float,
    times: int | None,
    resume: Resume | None,
    stay: float,
    outcome: Outcome | None,
    lasts: float | None = None,
) -> None:
    """Say a message again and again, for `lasts` s or for ever.

    A repeated motion ends with a neutral, a counted one after `stay` s.
    """
    said, pace = 0, Pace(rate)
    most = times if lasts is None else max(round(lasts * rate), 1)
    if resume:
        node.subscription("drive_status", DriveStatus, lambda received: resume.heed(received.message))

    @node.every(1 / rate)
    def say() -> None:
        nonlocal said
        if said == most:
            return
        said += 1
        message = make()
        if resume and resume.may(node.membership.heard().refusals, clock.now()):
            node.log.warn("begins anew by itself, as --resume says")
            publisher.let_go()
        publisher.publish(message)
        print(f"publishing #{said}: {message}\n", flush=True)
        if words := pace.count(clock.now(), node.membership.loop.awake_since):
            print(f"zteleop pub: {words}", file=sys.stderr)
        if outcome:
            outcome.note(message)
        if said == times:
            node.stop()

    try:
        node.spin(lasts)
        if said == times:
            node.spin(stay)
        if outcome:
            outcome.check()
    finally:
        if said != times:
            publisher.let_go()


def _say_what_comes(node: Node, publisher: Publisher[M], kind: type[M], outcome: Outcome | None) -> None:
    """Say each message that comes on standard input, at once; one that is none is told of, and left out.

    A last motion is obeyed for as long as any other. Raises BusError where none of several was.
    """
    documents, file, said, wrong = Documents(), sys.stdin.fileno(), 0, 0

    def say(texts: Iterable[str]) -> None:
        nonlocal said, wrong
        for text in texts:
            try:
                message = Draft(kind, text).make()
                if outcome:
                    to_command(message)
                    outcome.note(message)
                publisher.publish(message)
            except MessageError as error:
                wrong += 1
                print(printable(f"zteleop pub: {error}"), file=sys.stderr, flush=True)
            else:
                said += 1

    def read() -> None:
        if data := os.read(file, 1 << 16):
            say(documents.feed(data))
        else:
            say(documents.end())
            node.stop()

    try:
        node.membership.loop.watch(file, read)
        node.spin()
        node.membership.loop.unwatch(file)
        if outcome and said:
            node.spin(STAYS)
            outcome.check()
    finally:
        publisher.let_go()
    print(f"said {said}", file=sys.stderr)
    if wrong and not said:
        raise MessageError(f"none of what came is a {kind.__name__}")


def _is_command(topic: str, robot: str | None) -> bool:
    with suppress(ConfigError):
        return topic_of(resolve(topic, robot).path).command
    return topic_of(topic).command  # of whichever robot there is


def _await_hearer(node: Node, publisher: Publisher[M], name: Name, wanted: int, patience: float) -> bool:
    """Wait for so many who hear a topic, and say who does; False when nobody is known to."""
    start, told = clock.now(), False
    while not (heard := _hears(node, publisher, name, wanted)) and (waited := clock.now() - start) < patience:
        if waited > TELL_AFTER and not told:
            there = len(_hearers(node, name))
            whom = "who hears" if wanted == 1 else f"{wanted} who hear"
            so_far = f"{there} of {wanted} so far, " if 0 < there < wanted else ""
            print(f"zteleop pub: waits for {whom} {name}: {so_far}{_who_hears(node, name)}", file=sys.stderr)
            told = True
        node.spin(SETTLE)
    node.spin(SETTLE)
    if heard:
        print(f"zteleop pub: {_who_hears(node, name)}", file=sys.stderr)
    return heard


def _hears(node: Node, publisher: Publisher[M], name: Name, wanted: int = 1) -> bool:
    """Say whether so many hear; a robot's black box hears whatever is said, and is nobody it is said to."""
    known = len(_hearers(node, name))
    if wanted != 1:
        return known >= wanted
    # In this order: a black box may come between two questions, and must not be taken for somebody else.
    if not publisher.matched:
        return False
    return bool(known) or not presence.holders(node.membership.session, name.robot, presence.RECORDER)


def _hearers(node: Node, name: Name) -> list[Endpoint]:
    return _company.members(name, "sub", presence.endpoints(node.membership.session))


def _who_hears(node: Node, name: Name) -> str:
    session = node.membership.session
    return printable(_company.who_hears(name, presence.endpoints(session), session.unreached()))
