import argparse
import sys

from zteleop import config
from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.node import Node
from zteleop.cli import options
from zteleop.config import Config
from zteleop.errors import BusError
from zteleop.messages import DriveStatus
from zteleop.nodes.stopping import PATIENCE, REPEAT, Stopping, person


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add(parser)
    options.add_robot(parser)
    parser.add_argument(
        "--release", action="store_true", help="end your stop: it may drive again, from neutral"
    )
    parser.add_argument("--all", action="store_true", help="every robot; with --release, everybody's stops")
    parser.add_argument("--why", metavar="TEXT", default="", help="a reason, for others to read")


def run(arguments: argparse.Namespace) -> int:
    settings = options.load_anyhow(arguments)
    every = arguments.all and not arguments.release
    with options.join_for_any("stop", settings, settle=every or settings.robot is None) as node:
        if arguments.release:
            robot = options.find_robot(node.session, settings)
            print(printable(release(node, robot, arguments.all)))
            return 0
        return stop(node, _robots(node, settings, every), arguments.why)


def stop(node: Node, robots: list[str], why: str = "") -> int:
    """Stop these robots, say what each answers, and return 1 when one has not acknowledged it."""
    asked = [Stopping(node, person(), robot) for robot in robots]
    for stopping in asked:
        stopping.engage(clock.now(), why)  # before anything else is set up: somebody waits for it
    for stopping in asked:
        _listen(node, stopping)

    told: list[Stopping] = []

    def is_over() -> bool:
        """Go on saying it, tell each answer as it comes, and look whether there is more to say."""
        for stopping in asked:
            if stopping.heed(None, clock.now()) and stopping not in told:
                told.append(stopping)
                _tell(stopping)
        return len(told) == len(asked) and not any(stopping.repeats(clock.now()) for stopping in asked)

    node.until(is_over, 2 * REPEAT)
    if any(stopping.unheard for stopping in asked):  # only now: who is there may take time to find out
        print(printable(_who_is_here(node)), file=sys.stderr)
    return int(any(stopping.state != "done" for stopping in asked))


def release(node: Node, robot: str, everybodys: bool = False) -> str:
    """End one's own stops that a robot shows, or everybody's, and return what to tell; BusError when not."""
    statuses = node.subscription(f"/{robot}/drive_status", DriveStatus)
    stopping = Stopping(node, person(), robot)
    stopping.release(node.until(statuses.newest, PATIENCE), clock.now(), everybodys)
    _listen(node, stopping)
    node.until(lambda: stopping.heed(None, clock.now()), 2 * PATIENCE)
    if stopping.state != "done":
        raise BusError(stopping.words + (f"; {_who_is_here(node)}" if stopping.unheard else ""))
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
        print(printable(f"{stopping.words}; {advice}"), flush=True)
    else:
        print(printable(f"zteleop stop: {stopping.words}"), file=sys.stderr, flush=True)


def _who_is_here(node: Node) -> str:
    """Return who could have been meant, where a robot is not heard."""
    found = presence.robots(node.session)
    return f"heard here: {', '.join(found)}" if found else "no robot is heard here"


def _robots(node: Node, settings: Config, every: bool) -> list[str]:
    """Return the robots meant: of several that nobody has named all, unless somebody can be asked."""
    if settings.robot and not every:
        return [settings.robot]
    found = presence.robots(node.session)
    if len(found) > 1 and not every:
        return _ask(found)
    named = [settings.robot] if settings.robot else []
    return sorted({*found, *named}) or [config.own_name()]


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
