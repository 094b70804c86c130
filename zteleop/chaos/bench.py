"""A robot to do things to: its processes, an eye on its chip, and a place for whoever drives it."""

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple, Self

from zteleop.bus.node import Node
from zteleop.bus.settings import BusSettings
from zteleop.chaos.cable import Cable
from zteleop.chaos.eye import Eye, open_eye
from zteleop.chaos.place import Place
from zteleop.chaos.process import ZTELEOP, Process, actuator_of, door_of
from zteleop.chaos.terminal import Terminal
from zteleop.config import Config
from zteleop.drivers.faults import Faults
from zteleop.errors import BusError
from zteleop.machine.ids import new_id
from zteleop.messages import DriveStatus, Stop, Twist

START = 10.0
READY = 20.0
"""s; an ESC may take ten of them to arm"""
LOOK = 0.0005


class Subject(NamedTuple):
    """The robot that is meant."""

    settings: Config
    options: tuple[str, ...] = ()
    """of `zteleop actuator`"""
    environment: dict[str, str] = {}
    chip: str = ""
    """The file of a chip that is none of the bench's own, nor real."""


class Bench:
    """One start of a robot; whatever was started ends with it."""

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.place = Place(self.settings.driver == "simulated", subject.chip)
        limits, mixer = self.settings.drive.limits, self.settings.drive.mixer
        self.command = Twist.planar(limits.speed_of(mixer) / 4, limits.turn_of(mixer) / 8)
        self.operator: Process | None = None
        """whoever drives, where it is a process of its own"""
        self.terminal: Terminal | None = None
        """the operator's, where it has one"""
        self.others: list[Node] = []
        """more people on the bus"""
        self.notes: list[str] = []
        """what a certificate should say besides"""
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        self.place.leave()

    @property
    def settings(self) -> Config:
        """The robot's own."""
        return self.subject.settings

    def _start(self) -> None:
        self.eye: Eye = open_eye(self.settings, self.place.robot, self.place.chip)
        self._stack.callback(self.eye.close)
        where = (
            "--robot",
            self.place.robot,
            "--no-multicast-scouting",
            "--listen",
            endpoint(self.place.address),
        )
        command = [*ZTELEOP, "actuator", "--with-parent", *where, *self.subject.options]
        self.watchdog = self.run("actuator", command, leashed=True)
        self.await_robot()
        self.node = self.join()
        self.statuses = self.node.subscription("drive_status", DriveStatus)
        self.stops = self.node.publisher("stop", Stop)

    def await_robot(self) -> None:
        """Wait until it can be joined; raises BusError with its last words when it ends."""
        give_up = time.monotonic() + START
        while not self.place.address.exists():
            if self.watchdog.ended or time.monotonic() > give_up:
                raise BusError(f"the robot did not start: {self.watchdog.words}")
            time.sleep(LOOK)

    def await_ready(self) -> None:
        """Wait until somebody may begin to drive: who moves before can never begin anew.

        Raises BusError with the robot's last words when that takes too long.
        """
        if self.until(lambda: (status := self.status) and status.state != "starting", READY) is None:
            raise BusError(f"the robot did not get ready: {self.watchdog.words}")

    def run(
        self, name: str, command: Sequence[str], terminal: int | None = None, *, leashed: bool = False
    ) -> Process:
        """Start a process that ends with the bench."""
        bench = {} if leashed else {"ZTELEOP_CHAOS_BENCH": str(os.getpid())}
        process = Process(
            name,
            command,
            self.place.environment | self.subject.environment | bench,
            self.place.folder,
            terminal,
            leashed=leashed,
        )
        self._stack.callback(process.end)
        return process

    def join(self, place: Path | None = None) -> Node:
        """Join the robot's bus from here, by its own door or by a cable's."""
        bus = BusSettings(mode="client", connect=[endpoint(place or self.place.address)], multicast=False)
        node = Node("chaos", self.place.robot, bus)
        node.log.show = lambda line: None
        self._stack.callback(node.close)
        return node

    def lay_cable(self, place: Path) -> None:
        """Lead to the robot's door from another place, by a link that can be cut."""
        self.link = self._stack.enter_context(Cable(self.place.address, place))

    @property
    def actuator(self) -> int:
        """The process that obeys; raises BusError while there is none."""
        found = actuator_of(self.watchdog.pid)
        if found is None:
            raise BusError(f"no actuator runs: {self.watchdog.words}")
        return found

    @property
    def door(self) -> int:
        """The process by which the robot is on the bus; raises BusError while there is none."""
        found = door_of(self.watchdog.pid)
        if found is None:
            raise BusError(f"no door is open: {self.watchdog.words}")
        return found

    def path(self) -> list[int]:
        """Return the processes that bring the wheels to rest, and this one, which sees it."""
        watchdog = self.watchdog.pid
        theirs = (watchdog, door_of(watchdog), actuator_of(watchdog), self.operator and self.operator.pid)
        return [os.getpid(), *(pid for pid in theirs if pid)]

    @contextmanager
    def faults(self) -> Iterator[Faults]:
        """Open a simulated chip for faults to be put in; what no transfer has met stays."""
        faults = Faults(self.place.chip)
        try:
            yield faults
        finally:
            faults.close()

    @property
    def status(self) -> DriveStatus | None:
        """What the robot says of itself, if it has said anything since the last look."""
        return self.statuses.newest()

    def meanwhile(self, context: AbstractContextManager[object]) -> None:
        """Enter a context that ends with the bench."""
        self._stack.enter_context(context)

    def until(self, condition: Callable[[], object], patience: float) -> float | None:
        """Look until a condition holds; return when, by the monotonic clock, or None if it never does."""
        give_up = time.monotonic() + patience
        while not condition():
            if time.monotonic() > give_up:
                return None
            time.sleep(LOOK)
        return time.monotonic()

    def press_stop(self, node: Node | None = None, by: str = "chaos") -> None:
        """Press Stop once."""
        stop = Stop(engaged=True, id=new_id(), by=by, why="")
        (node.publisher("stop", Stop) if node else self.stops).publish(stop)

    def release(self, stop: int) -> None:
        """Release the stop of that id."""
        self.stops.publish(Stop(engaged=False, id=stop, by="chaos", why=""))


def endpoint(place: Path) -> str:
    return f"unixsock-stream/{place}"
