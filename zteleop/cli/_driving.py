"""One operator at a terminal who drives with a device: the screen, and the lane of a stop."""

from collections.abc import Callable, Mapping
from typing import Protocol, Self

from zteleop.bus import clock
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.bus.presence import Robots, who_is_here
from zteleop.cli._floor import Floor
from zteleop.cli._painter import HEARD_WITHIN, Painter, Shown
from zteleop.config import Config
from zteleop.control.report import to_vehicle
from zteleop.inputs import Input
from zteleop.machine.guardian import guarded
from zteleop.messages import Vehicle
from zteleop.nodes.switches import Switches
from zteleop.nodes.teleop import Teleop
from zteleop.screen.dashboard import Dashboard, Task
from zteleop.screen.view import View

KILLED = "\r\nzteleop was killed; this terminal is as it was, and Enter brings its prompt\r\n"


class Device(Input, Shown, Protocol):
    """An input with a terminal, from which it can be suspended."""

    @property
    def switches(self) -> Mapping[str, bool]:
        """Which switches there are, and which are on."""

    @property
    def suspending(self) -> bool:
        """Ctrl-Z was pressed: publish neutral, then call `suspend`."""

    def settle(self, clock: Callable[[], float]) -> None:
        """Wait, not for long, until the terminal has said what it can; nothing typed then moves."""

    def suspend(self, now: float) -> None:
        """Stop the process as Ctrl-Z asked and return when it goes on, neutral."""

    def __enter__(self) -> Self: ...


def drive_at_terminal(
    node: Node,
    settings: Config,
    device: Device,
    source: str,
    known: Dashboard,
    meet: Callable[[Vehicle], None] = lambda vehicle: None,
    watch: Callable[[View], None] = lambda view: None,
    task: Callable[[], Task] = Task,
) -> None:
    """Show the screen and drive until the operator has enough; `meet` hears once which vehicle it is.

    What is seen goes to `watch` as well; `task` says what there is to do.
    """
    node.log.show = lambda line: None  # nothing prints over the screen: it shows the log itself
    terminal, switches = device.terminal, Switches(node)
    switches.heed(device.switches)  # which fails, where it does, before there is a screen
    with guarded(terminal.name, terminal.farewell + KILLED), device, Call(settings.bus) as lane:
        device.settle(clock.now)
        paint = Painter(device, known)
        paint(View())
        session = node.membership.session
        robots, floor = Robots(session), Floor(node)
        vehicle = find_vehicle(node, settings)
        device.settle(clock.now)  # once more: what was typed while nobody looked

        def show(view: View) -> None:
            watch(view)
            if view.status is None:
                others = [robot for robot in robots.there() if robot != known.robot]
                unreached = session.unreached()
                words = who_is_here(others, known.robot, unreached) if others or unreached else ""
                paint.known = paint.known._replace(others=words)
            paint.known = paint.known._replace(task=task())
            if (marks := floor.news()) is not None:
                paint.known = paint.known._replace(floor=marks)
            switches.heed(device.switches)
            if device.suspending:
                device.suspend(clock.now())  # its last word is said
            else:
                paint(view)

        meet(vehicle)
        Teleop(node, device, source, vehicle, show, lane).run()


def find_vehicle(node: Node, settings: Config) -> Vehicle:
    """Return what the robot says of itself; when it is not there yet, what the settings say."""
    give_up = clock.now() + HEARD_WITHIN
    while clock.now() < give_up:
        if vehicle := node.membership.heard().vehicle:
            return vehicle
        node.spin(0.01)
    return to_vehicle(settings.drive, settings.tick_us)
