"""The watchdog: `zteleop actuator` is this program, which starts the others."""

import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager

import msgspec

from zteleop import config
from zteleop.bus import clock, presence
from zteleop.bus.lane.ear import Ear
from zteleop.bus.node import Node
from zteleop.bus.session import Session, open_session
from zteleop.bus.settings import ANY_PORT, BEHIND, ROBOT_ENDPOINT, BusSettings
from zteleop.config import Config
from zteleop.drivers import PulseDriver, output_enable
from zteleop.drivers.output_enable import OutputEnable
from zteleop.errors import DeviceError
from zteleop.machine import realtime, stderr
from zteleop.machine.child import Child
from zteleop.machine.door import Door
from zteleop.machine.sidecar import Recorder
from zteleop.machine.stop_file import StopFile
from zteleop.messages import WatchdogStatus
from zteleop.nodes.watchdog import Watchdog
from zteleop.processes import PROGRAMS

PROGRAM = PROGRAMS["watchdog"]
LARGEST = 2**20
"""bytes of a message that passes a robot's door: whoever sends more would hold up the commands of others."""
LONGEST_PLACE = 70
"""characters of a folder for the private socket, whose whole path may have a hundred"""
GLANCE, LOOK_EVERY = 0.005, 0.05
"""s between looks at the door: until it is open, and then"""
STARTED_WITHIN = 3.0
"""s in which all that a robot is made of has said that it is there"""
SPEAKS_WITHIN = 1.0
"""s; a watchdog says five times a second what it sees"""
DOOR, ACTUATOR, BLACKBOX = (
    [sys.executable, "-m", "zteleop.processes", name] for name in ("door", "actuator", "blackbox")
)


def run(settings: Config, hand: PulseDriver, joined: Callable[[Node], object]) -> int:
    """Watch over an actuator of the robot in the settings; `joined` is told of the node."""
    robot = settings.robot or ""
    chip = settings.driver_settings(settings.driver, robot)
    with ExitStack() as stack:
        place = None if len(tempfile.gettempdir()) < LONGEST_PLACE else "/tmp"
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="zteleop-", dir=place))
        bus = _reachable(settings.bus)
        door = Door(DOOR, lambda first: _orders(bus, first), f"{folder}/door", stderr.tell)
        stack.callback(door.close)
        behind = BusSettings(mode="client", connect=[f"{BEHIND}{door.place}"], multicast=False)
        session = stack.enter_context(open_session(behind))
        if code := _open(door):
            return code
        node = stack.enter_context(_join(robot, session))
        door.tell = node.log.error
        joined(node)
        pin = output_enable(settings.driver, chip)
        if pin:
            stack.callback(pin.close)
        _ask_for_privileges(node, tell=settings.driver != "simulated")
        orders = msgspec.json.encode(msgspec.structs.replace(settings, bus=behind))
        child = Child(ACTUATOR, orders, hand.shared())
        recorder = Recorder(BLACKBOX, orders, node.log.warn) if settings.blackbox else None
        stop_file = StopFile(config.state_folder(robot) / "stop", node.log.error)
        lane = stack.enter_context(closing(Ear(robot, bus, node.log.warn)))
        dog = Watchdog(node, settings.drive, hand, child, stop_file, _switch(node, pin), recorder, lane)
        node.every(LOOK_EVERY)(lambda: door.tend(clock.now()))  # last: it shares its wakes with the dog's
        return dog.run()


def _open(door: Door) -> int:
    """Start the door, and wait until it is open; return its exit code when it never will be."""
    door.start(clock.now())
    while not door.is_open:
        time.sleep(GLANCE)
        door.tend(clock.now())
        if door.refused:
            return door.refused
    return 0


@contextmanager
def _join(robot: str, session: Session) -> Iterator[Node]:
    """Join the bus as the only watchdog of that robot."""
    before = presence.holders(session, robot, "watchdog")
    with Node("watchdog", robot, session=session) as node:
        if holders := presence.rivals(session, robot, "watchdog", before):
            _pass_over(node, ", ".join(holders))
        yield node


def _pass_over(node: Node, holders: str) -> None:
    """Take a place whose holders say nothing: anybody may hold one, and only a watchdog speaks.

    Raises DeviceError when one does.
    """
    statuses = node.subscription("watchdog", WatchdogStatus)
    if node.membership.until(statuses.newest, SPEAKS_WITHIN):
        raise DeviceError(f"robot {node.robot} has an actuator already: {holders}; stop it, or say --robot")
    node.log.warn(f"{holders} holds the place of this robot's watchdog and says nothing; it is passed over")


def _switch(node: Node, pin: OutputEnable | None) -> Callable[[bool], bool]:
    """Return what lets the chip's outputs through, or cuts them, and says whether a pin did."""

    def switch(on: bool) -> bool:
        try:
            if pin:
                pin.enable() if on else pin.disable()
        except DeviceError as error:
            node.log.error(str(error), "oe")
            return False
        return pin is not None

    return switch


def _reachable(bus: BusSettings) -> BusSettings:
    """Return how the door joins the bus: where strangers find it, unless it is a client of a router."""
    if bus.mode == "client":
        return bus
    listen = bus.listen
    if bus.mode == "peer" and bus.multicast and not listen:
        listen = [ROBOT_ENDPOINT, ANY_PORT]
    return msgspec.structs.replace(bus, listen=listen, largest=LARGEST)


def _orders(bus: BusSettings, first: bool) -> bytes:
    return msgspec.json.encode({"bus": bus, "settle": first})


def _ask_for_privileges(node: Node, tell: bool) -> None:
    """Ask for them, and tell what is missing last: it is what matters least to whoever starts a robot."""
    missing = realtime.ask_for(PROGRAM.priority, PROGRAM.oom_score)
    if missing and tell:
        words = f"runs without {', '.join(missing)}: not permitted; deploy/README.md says how"
        node.membership.loop.alarm(lambda: node.log.info(words)).ring_at(clock.now() + STARTED_WITHIN)
