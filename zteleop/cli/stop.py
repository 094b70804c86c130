import argparse
import sys
import threading
import time

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.config import Config
from zteleop.errors import BusError
from zteleop.messages import DriveStatus
from zteleop.nodes.stop_request import ACKNOWLEDGED_WITHIN, REPEAT, Stopping, person

EXAMPLES = (
    'zteleop stop archangel --why "a cat"',
    "zteleop stop --release archangel",
)
AT_A_SHELL = "at a shell"
"""why, where nobody says so: which of the ways to stop it that somebody has"""
GLANCE = 0.01
TELL_AFTER = 1.0
"""s until it says for whom it waits"""
SOON = 0.6
"""s in which a robot that is there has answered"""
GOES_ON = f"goes on saying so until {REPEAT:g} s are over, to whoever comes late; the stop outlasts this"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    parser.add_argument(
        "--release",
        action="store_true",
        help="end your stop: whatever it stopped may drive again, from neutral",
    )
    parser.add_argument("--all", action="store_true", help="every robot; with --release, everybody's stops")
    parser.add_argument("--why", metavar="TEXT", default="", help="a reason, for others to read")


def run(arguments: argparse.Namespace) -> int:
    settings = _options.load_anyhow(arguments)
    every = arguments.all and not arguments.release
    settle = every or settings.robot is None
    if arguments.release:
        with _options.join_for_any("stop", settings, settle=settle) as node:
            return release_each(node, _robots(node, settings, settings.robot is None), arguments.all)
    with Call(settings.bus) as lane:
        stops = Stops(lane, arguments.why)
        if settings.robot:
            stops.engage([settings.robot])  # before anything else is set up: somebody waits for it
        try:
            joined = stops.join(settings, settle)
        except BusError as error:
            return stops.finish_alone(error)
        with joined as node:
            stops.engage(_robots(node, settings, every))
            return stops.finish(node)


class Stops:
    """Stops robots on the bus and on the lane beside it, and tells what each answers as it comes."""

    def __init__(self, lane: Call, why: str) -> None:
        self._lane = lane
        self._why = why
        self._asked: dict[str, Stopping] = {}
        self._told: set[str] = set()

    def engage(self, robots: list[str]) -> None:
        """Begin to stop those that are not asked yet."""
        for robot in robots:
            if robot not in self._asked:
                self._asked[robot] = Stopping(None, person(), robot, self._lane)
                self._asked[robot].engage(clock.now(), self._why or AT_A_SHELL)

    def join(self, settings: Config, settle: bool) -> Node:
        """Join the bus, and say meanwhile on the lane what is asked for; raises BusError as that does."""
        joined: list[Node | BaseException] = []

        def join() -> None:
            try:
                joined.append(_options.join_for_any("stop", settings, settle))
            except BaseException as error:  # a panic of zenoh's is no Exception
                joined.append(error)

        # by hand, as a stop's first word would wait 8 ms for the import of concurrent.futures
        joining = threading.Thread(target=join)
        joining.start()
        while joining.is_alive():
            self.heed()
            joining.join(GLANCE)
        if isinstance(joined[0], BaseException):
            raise joined[0]
        return joined[0]

    def finish_alone(self, error: BusError) -> int:
        """Finish without a bus; raises its error where one of them has not answered on the lane."""
        while self._asked and not self.heed():
            time.sleep(GLANCE)
        if not self._asked or any(stopping.state != "done" for stopping in self._asked.values()):
            raise error
        print(printable(f"zteleop stop: warning: {error}; it went out as datagrams alone"), file=sys.stderr)
        return 0

    def finish(self, node: Node) -> int:
        """Go on on both ways until each has answered; return 1 when one has not."""
        for stopping in self._asked.values():
            stopping.join(node)
        self.heed()
        for stopping in self._asked.values():
            _listen(node, stopping)
        asking = threading.Thread(target=self._ask_who_is_meant, args=(node,), daemon=True)
        if not node.membership.until(self.heed, SOON) and self._told != self._asked.keys():
            asking.start()  # beside it: who answers late must not keep the stop from being said
        node.membership.until(self.heed, 2 * REPEAT)
        unheard = [stopping for stopping in self._asked.values() if stopping.unheard]
        for stopping in unheard:
            if stopping.state == "done":
                words = f"{stopping.robot} answered by datagram; on the bus it is not heard"
                print(printable(words), file=sys.stderr)
        return int(any(stopping.state != "done" for stopping in self._asked.values()))

    def _ask_who_is_meant(self, node: Node) -> None:
        """Say which robots there are, where one that does not answer is not among them."""
        from difflib import get_close_matches  # which a stop that is answered does not wait for

        session = node.membership.session
        for robot in self._asked.keys() - self._told - set(presence.robots(session)):
            words = f"{robot} does not answer so far, and is asked on; {presence.here(session, robot)}"
            if get_close_matches(robot, ["release"], 1, 0.75):
                words += "; zteleop stop --release is what lets a robot drive again"
            print(printable(words), file=sys.stderr, flush=True)

    def heed(self) -> bool:
        """Go on saying it, tell each answer as it comes, and say whether all is said."""
        now = clock.now()
        for answer in self._lane.answers():
            if asked := self._asked.get(answer.robot):
                asked.hear_lane(answer, now)
        for robot, stopping in self._asked.items():
            if stopping.heed(None, now) and robot not in self._told:
                self._told.add(robot)
                _tell(stopping)
        return len(self._told) == len(self._asked) and not any(s.repeats(now) for s in self._asked.values())


def release_each(node: Node, robots: list[str], everybodys: bool) -> int:
    """Release each and tell of it; return 1 where one of several stays stopped, raise for the only one."""
    failed = 0
    for robot in robots:
        try:
            print(printable(release(node, robot, everybodys)), flush=True)
        except BusError as error:
            if len(robots) == 1:
                raise
            failed = 1
            print(printable(f"zteleop stop: {error}"), file=sys.stderr, flush=True)
    return failed


def release(node: Node, robot: str, everybodys: bool = False) -> str:
    """End one's own stops that a robot shows, or everybody's, and return what to tell; BusError when not."""
    statuses = node.subscription(f"/{robot}/drive_status", DriveStatus)
    stopping = Stopping(node, person(), robot)
    status = node.membership.until(statuses.newest, TELL_AFTER)
    if status is None:
        here = presence.here(node.membership.session, robot)
        print(printable(f"zteleop stop: waits for {robot}; {here}"), file=sys.stderr, flush=True)
        status = node.membership.until(statuses.newest, ACKNOWLEDGED_WITHIN - TELL_AFTER)
    stopping.release(status, clock.now(), everybodys)
    _listen(node, stopping)
    node.membership.until(lambda: stopping.heed(None, clock.now()), 2 * ACKNOWLEDGED_WITHIN)
    if stopping.state != "done":
        here = presence.here(node.membership.session, robot) if stopping.unheard else ""
        raise BusError(f"{stopping.words}; {here}" if here else stopping.words)
    return stopping.words


def _listen(node: Node, stopping: Stopping) -> None:
    node.subscription(
        f"/{stopping.robot}/drive_status",
        DriveStatus,
        lambda heard: stopping.heed(heard.message, heard.at),
    )


def _tell(stopping: Stopping) -> None:
    if stopping.state == "done":
        advice = f"zteleop stop --release {stopping.robot} lets it drive again, from neutral"
        print(printable(f"{stopping.words}; {advice}\n{GOES_ON}", keep="\n"), flush=True)
    else:
        print(printable(f"zteleop stop: {stopping.words}"), file=sys.stderr, flush=True)


def _robots(node: Node, settings: Config, every: bool) -> list[str]:
    """Return the robots meant: of several that nobody has named all, unless somebody can be asked."""
    if settings.robot and not every:
        return [settings.robot]
    found = presence.robots(node.membership.session)
    if len(found) > 1 and not every:
        return _ask(found)
    named = [settings.robot] if settings.robot else []
    return sorted({*found, *named}) or [
        _options.spoken_of(node.membership.session) or _options.own_robot(node.membership.session)
    ]


def _ask(found: list[str]) -> list[str]:
    """Ask which; whatever is no robot's name, nothing as well, means all."""
    print(printable(f"{len(found)} robots are heard: {', '.join(found)}"), flush=True)
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        print("stops all of them, as none was named", flush=True)
        return found
    try:
        answer = input("stop which? Enter stops all: ").strip()
    except EOFError:
        answer = ""
    return [answer] if answer in found else found
