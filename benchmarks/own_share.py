"""How long a key takes in zteleop's own code: teleop from bytes to `put`, actuator from sample to I2C.

Both run in this process, one after the other; zenoh and the operating system between them are not timed.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from stamped import StampedDriver, StampedPublisher, TypedTerminal

from zteleop.bus import clock
from zteleop.bus.loop import Timer
from zteleop.bus.node import Node
from zteleop.bus.session import Session, open_session
from zteleop.bus.settings import BusSettings
from zteleop.bus.subscription import Subscription
from zteleop.cli._painter import Painter
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.drivers import open_driver
from zteleop.inputs.keyboard import Keyboard
from zteleop.inputs.levers import Steps
from zteleop.machine import link
from zteleop.machine.stop_file import StopFile
from zteleop.nodes.actuator import AT_MOST_EVERY, Actuator
from zteleop.nodes.teleop import Teleop
from zteleop.recording.journal import Journal
from zteleop.screen.dashboard import Dashboard

KEYS = (b"\x1b[D", b"\x1b[C")
WARM_UP = 20


class OwnShare(NamedTuple):
    """Milliseconds of each key."""

    keyboard: list[float]
    actuator: list[float]
    draw: list[float]


class HeldNode(Node):
    """A node whose handlers and timers run when this program says, not when samples come."""

    def __init__(self, name: str, session: Session) -> None:
        self.puts: dict[str, StampedPublisher] = {}
        self.inboxes: dict[str, tuple[Subscription[Any], Any]] = {}
        self.timers: list[Callable[[], None]] = []
        self.alarms: list[Timer] = []
        super().__init__(name, "bench", session=session)
        self.log.show = lambda line: None

    def _declare(self, name: Any, *rest: Any) -> Any:
        self.puts[name.path] = StampedPublisher(super()._declare(name, *rest))
        return self.puts[name.path]

    def subscription(self, topic: str, types: Any, handler: Any = None, **options: Any) -> Any:
        inbox = super().subscription(topic, types, **options)
        self.inboxes[topic] = (inbox, handler)
        return inbox

    def alarm(self, action: Callable[[], object]) -> Timer:
        self.alarms.append(super().alarm(action))
        return self.alarms[-1]

    def ring(self) -> None:
        """Run the alarms that are due, as the loop does after the handlers."""
        for alarm in self.alarms:
            if alarm.due <= clock.now():
                alarm.reschedule(clock.now())
                alarm.action()

    def every(self, period: float) -> Any:
        return self.timers.append

    def watch(self, file: int, action: Callable[[], object]) -> None:
        self.watched = action


def own_share(presses: int) -> OwnShare:
    """Press keys; return what each cost."""
    share = OwnShare([], [], [])
    bus = BusSettings(multicast=False, listen=["tcp/127.0.0.1:0"])
    with tempfile.TemporaryDirectory() as folder, HeldNode("keyboard", open_session(bus)) as node:
        settings = DriveSettings()
        driver = StampedDriver(open_driver("simulated", {"path": f"{folder}/chip"}))
        robot = HeldNode("actuator", node.membership.session)
        watchdog, theirs = link.pair()

        def press_all() -> None:
            watchdog.say(link.HEARS)
            robot.watched()
            _press_all(node, robot, settings, driver, share, presses, watchdog)

        robot.spin = press_all
        end = link.ActuatorEnd(theirs)
        stop_file = StopFile(Path(folder) / "stop", print)
        Actuator(robot, settings, driver, end, stop_file, Journal(Path(folder), "acts")).run()
    return share


def _press_all(
    node: HeldNode,
    actuator: HeldNode,
    settings: DriveSettings,
    driver: Any,
    share: OwnShare,
    presses: int,
    watchdog: link.WatchdogEnd,
) -> None:
    terminal, views = TypedTerminal(), []
    keyboard = Keyboard("step", terminal=terminal)  # type: ignore[arg-type]
    teleop = Teleop(node, keyboard, "keyboard", to_vehicle(settings, driver.tick_us), views.append)
    paint = Painter(keyboard, Dashboard("bench", "step", keyboard.speeds, steps=Steps()))
    inbox, handler = actuator.inboxes["pwm/keyboard"]
    for index in range(WARM_UP + presses):
        watchdog.say(link.HEARS)
        actuator.watched()
        for act in actuator.timers:  # beats, status, and the clock's own step
            act()
        watchdog.read()
        teleop.obey()
        for _ in inbox.take():
            pass
        time.sleep(2 * AT_MOST_EVERY)
        terminal.typed = KEYS[index % 2]
        began = time.perf_counter()
        node.membership.heard().listen()
        teleop.obey()
        share.keyboard.append(1000 * (node.puts["pwm/keyboard"].at - began))
        began, sample = time.perf_counter(), inbox.ring.try_recv()
        handler(inbox.read(sample))
        actuator.ring()
        share.actuator.append(1000 * (driver.at - began))
        assert driver.at > began, "the key moved nothing"
        node.alarms[-1].due = clock.now()  # the picture, which waits until the command is out
        node.ring()
        began = time.perf_counter()
        paint(views[-1])
        share.draw.append(1000 * (time.perf_counter() - began))
    for samples in share:
        del samples[:WARM_UP]
