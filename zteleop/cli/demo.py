import argparse
import secrets
import shutil
import socket
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from importlib.util import find_spec
from math import hypot
from pathlib import Path

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.settings import SAME_MACHINE, SAME_MACHINE_DOOR, BusSettings
from zteleop.cli import _bad_link, _pages, _scenes, web
from zteleop.cli._driving import find_vehicle
from zteleop.cli._scratch import DEMO, scratch
from zteleop.cli.keyboard import drive_with_keys
from zteleop.config import Config
from zteleop.control.vehicles import VEHICLES
from zteleop.errors import BusError
from zteleop.inputs import Drive
from zteleop.inputs.script import Script
from zteleop.machine.leash import Process, last_words, leashed
from zteleop.messages import Odometry
from zteleop.nodes.teleop import Teleop
from zteleop.screen.dashboard import Task
from zteleop.screen.floor import marks
from zteleop.screen.view import View
from zteleop.sim.plan import plan

EXAMPLES = (
    "zteleop demo",
    "zteleop demo --drive hold",
)
OTHER: dict[Drive, tuple[Drive, str]] = {
    "step": ("hold", "drives while a key is held"),
    "hold": ("step", "each press moves a lever, and there it stays"),
}
SCENE, OPEN = "eight", "floor"
"""where it drives at a screen, and where nobody sees what stands in its way"""
START = 10.0
HIDDEN = "other terminals see the robot that was on this machine before, and not this one"
ALONE = "other terminals do not see this robot, as another was here when it started: q, and start it anew"
LOOK_EVERY = 1.0
"""s between two looks whether that one is still there"""
PARTS = ("robot", "simulator")
"""its processes beside this one"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--scene",
        metavar="NAME",
        help=f"where it drives: {', '.join(_scenes.names())}, or a file (default: {SCENE})",
    )
    parser.add_argument("--vehicle", choices=[*VEHICLES], default="car", help="what drives (default: car)")
    parser.add_argument("--drive", choices=["step", "hold"], help="how the keys drive (default: step)")
    parser.add_argument("--web", action="store_true", help="drive from a page in a browser instead")
    _bad_link.add(parser, "what operator and simulator say")


def run(arguments: argparse.Namespace) -> int:
    """Start actuator and simulator as processes of their own; drive them from here."""
    if arguments.web:
        _pages.expect_websockets()
    screen = sys.stdin.isatty() and sys.stdout.isatty()
    place = arguments.scene or (SCENE if screen or arguments.web else OPEN)
    scene = _scenes.find(place)
    hidden = _is_taken(SAME_MACHINE)
    robot = f"demo-{secrets.token_hex(2)}"
    endpoint = f"tcp/127.0.0.1:{_free_port()}"
    with ExitStack() as stack:
        folder = stack.enter_context(scratch(DEMO))
        log = stack.enter_context((folder / "log").open("w"))
        (folder / "config.toml").write_text(f'[drivers.simulated]\npath = "{folder / "chip"}"\n')
        where = ["--config", str(folder / "config.toml"), "--robot", robot, "--no-multicast-scouting"]
        vehicle = arguments.vehicle
        actuator = [
            "actuator",
            *where,
            "--vehicle",
            vehicle,
            "--listen",
            endpoint,
            "--listen",
            SAME_MACHINE_DOOR,
        ]
        simulator = ["sim", vehicle, *where, "--connect", endpoint, "--listen", "tcp/127.0.0.1:0"]
        simulator += ["--scene", place, *_bad_link.as_typed(arguments)]
        simulator += ["--camera"] if arguments.web and find_spec("PIL") else []
        keeps = {"XDG_STATE_HOME": str(folder)}  # a demo leaves nothing behind
        children = [stack.enter_context(leashed(verb, log, keeps)) for verb in (actuator, simulator)]
        bus = BusSettings(connect=[endpoint], listen=["tcp/127.0.0.1:0"], multicast=False)
        node = stack.enter_context(Node("web" if arguments.web else "keyboard", robot, bus))
        _bad_link.worsen(node, arguments)
        await_robot(node, children, Path(log.name))
        if arguments.web:
            print(f"{HIDDEN}\n" * hidden, end="")
            web.drive_from_page(node, Config(bus=bus), _pages.Place(port=0))
            return 0
        if screen:
            trip = Trip()
            lost = partial(ended, children, Hidden() if hidden else None)
            drive = drive_with_keys(
                node, Config(bus=bus), arguments.drive, marks(plan(scene)), trip, task=lost
            )
            ending = farewell(trip, drive)
        else:
            return drive_figure(node)
    print(ending)  # all of it is over
    return 0


class Hidden:
    """What there is to say while others do not see this robot."""

    def __init__(self) -> None:
        self._looked = clock.now()
        self._words = HIDDEN

    @property
    def words(self) -> str:
        now = clock.now()
        if now - self._looked >= LOOK_EVERY:
            self._looked, self._words = now, HIDDEN if _is_taken(SAME_MACHINE) else ALONE
        return self._words


def ended(children: Sequence[Process], hidden: Hidden | None = None) -> Task:
    """Return, where a part of the demo is gone, which, and what to do; else who does not see it, if so."""
    gone = [name for name, child in zip(PARTS, children, strict=True) if child.poll() is not None]
    if hidden and not gone:
        return Task([("demo", hidden.words)])
    lines = [("demo", f"its {' and its '.join(gone)} ended: q, and start another")] if gone else ()
    return Task(lines, ends="robot" in gone)


def drive_figure(node: Node) -> int:
    """Drive a scripted figure and print a line a second; return 0 when the car moved."""
    print("no terminal: driving a figure of eight for 10 s", flush=True)
    node.log.show = lambda line: print(line, file=sys.stderr)
    with Script() as script:
        teller = Teller()
        Teleop(node, script, "program", find_vehicle(node, Config()), teller).run()
    print(f"drove {teller.trip.distance:.1f} m and stopped")
    return 0 if teller.trip.distance > 0 else 1


def farewell(trip: "Trip", drive: Drive) -> str:
    """Return what was driven, and three commands that show something new."""
    other, how = OTHER[drive]
    program = as_typed()
    steps = [
        (f"{program} demo --drive {other}", how),
        (f"{program} keyboard --help", "every key"),
        (f"{program} doctor", "what this machine has for a robot of your own"),
    ]
    width = max(len(command) for command, _ in steps) + 3
    drove = f"{trip.distance:.1f} m, {trip.fastest:.2f} m/s at most" if trip.distance else "nowhere"
    return "\n".join(
        [f"drove {drove}", "try next:", *(f"  {command:{width}}{does}" for command, does in steps)]
    )


def as_typed() -> str:
    """Return what the program was called in the shell: also without an activated environment."""
    if shutil.which("zteleop"):
        return "zteleop"
    return f"{sys.orig_argv[0]} -m zteleop" if sys.argv[0].endswith("__main__.py") else sys.argv[0]


class Trip:
    """How far a car came, in m, and how fast, in m/s."""

    def __init__(self) -> None:
        self.distance = 0.0
        self.fastest = 0.0
        self.place: tuple[float, float] | None = None

    def __call__(self, view: View) -> None:
        if view.odom is None:
            return
        at = view.odom.pose.pose.position
        self.distance += hypot(at.x - self.place[0], at.y - self.place[1]) if self.place else 0.0
        self.fastest = max(self.fastest, abs(view.odom.twist.twist.linear.x))
        self.place = (at.x, at.y)


class Teller:
    """Prints a status line a second."""

    def __init__(self) -> None:
        self.trip = Trip()
        self._began = 0.0
        self._due = 0.0

    def __call__(self, view: View) -> None:
        self.trip(view)
        if not self._began and view.status and view.odom:
            self._began = self._due = view.now
        if self._began and view.now >= self._due:
            self._due += 1.0
            print(f"{view.now - self._began:4.0f} s  {self._line(view)}", flush=True)

    def _line(self, view: View) -> str:
        if view.status is None or view.odom is None:
            return "no robot heard"
        pulses = "  ".join(f"{pulse.name} {pulse.duty_ticks}" for pulse in view.status.pulses)
        x, y = self.trip.place or (0.0, 0.0)
        speed = view.odom.twist.twist.linear.x
        return f"{view.status.state:13}  {speed:5.2f} m/s  x {x:6.2f} m  y {y:6.2f} m  {pulses}"


def await_robot(node: Node, children: Sequence[Process], log: Path) -> None:
    """Wait until the car stands on its wheels; raises BusError with a child's last words when it does not."""
    odoms = node.subscription("odom", Odometry)
    give_up = clock.now() + START
    while clock.now() < give_up and all(process.poll() is None for process in children):
        if node.membership.heard().ready and odoms.newest():
            return
        node.spin(0.01)
    raise BusError(f"the simulated robot did not start: {last_words(log)}")


def _is_taken(endpoint: str) -> bool:
    """Say whether somebody listens at an endpoint of this machine, by which others would find the demo.

    Nobody is called for that: who listens need not answer, and whoever asks may be driving.
    """
    host, _, port = endpoint.removeprefix("tcp/").rpartition(":")
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # where one listened before is free
        try:
            probe.bind((host, int(port)))
        except OSError:
            return True
        return False


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
