"""A robot on a bench, a node in this process that drives it, and actuators with a defect put in."""

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from rig import NEUTRAL, Process, Rig, every, hear, repeating, until

from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.machine.ids import new_id
from zteleop.messages import DriveStatus, Pwm, Stop, WatchdogStatus

FORWARD, DRIVEN = Pwm(390, 400), (390, 400)
STREAM = 0.02
START = """
import sys
from zteleop.cli import main
from zteleop.processes import watchdog
watchdog.ACTUATOR = [sys.executable, "-c", sys.argv[1], "zteleop.processes", "actuator"]
sys.exit(main(["actuator", *sys.argv[2:]]))
"""
ACTUATOR = """
import sys
{defect}
from zteleop.processes.__main__ import main
sys.exit(main(sys.argv[2:]))
"""
IGNORES_IDLENESS = """
from zteleop.control.gate import Gate, Refusal
from zteleop.control.mux import Silences
judge = Gate.judge
def lax(*arguments):
    refusal = judge(*arguments)
    return None if refusal is Refusal.OPERATOR_IDLE else refusal
Gate.judge, Silences.idle = lax, lambda self, claim, now: False
"""
IGNORES_SILENCE = """
from zteleop.control.mux import Silences
Silences.silent = lambda self, claim, now: False
"""
HEARS_NO_STOP = """
from zteleop.bus.node import Node
subscription = Node.subscription
def deaf(self, topic, types, handler=None, **options):
    return subscription(self, topic, types, (lambda _: None) if topic == "stop" else handler, **options)
Node.subscription = deaf
"""
MOVES_ALTHOUGH_STOPPED = """
from zteleop.control.admission import Admission
hold = Admission.hold
Admission.hold = lambda self, reason, *words: None if reason == "stop" else hold(self, reason, *words)
"""
LEAVES_SLOWLY = """
import time
from zteleop.bus.node import Node
close = Node.close
Node.close = lambda self: time.sleep(1.0) or close(self)
"""
MOVES_BY_ITSELF = """
from zteleop.nodes.output import Output
write = Output.write
def creep(self, pulse_us, now):
    if pulse_us != self._neutral_us:
        self.last = pulse_us
    write(self, getattr(self, "last", pulse_us), now)
Output.write = creep
"""


class Bench:
    """A robot, and a node in this process that can drive it and hears what is said of it."""

    def __init__(self, rig: Rig, watchdog: Process) -> None:
        self.rig, self.watchdog = rig, watchdog
        self.last: dict[str, object] = {}
        self.node: Node = rig.node()
        self.statuses = self.node.subscription("drive_status", DriveStatus)
        self.dogs = self.node.subscription("watchdog", WatchdogStatus)
        heard = self.node.membership.heard()

        def ready() -> bool:
            heard.listen()
            return bool(heard.beat and heard.vehicle and heard.vehicle.ready)

        until(ready, "a robot that is ready")
        self.pwm: Publisher[Pwm] = self.node.publisher("pwm", Pwm, source="keyboard")

    @contextmanager
    def driven(self, acts: bool = True) -> Iterator[None]:
        """Drive until the block ends, and then fall silent."""
        self.pwm.act()
        with repeating(lambda: (self.pwm.publish if acts else self.pwm.repeat)(FORWARD), STREAM):
            self.moves()
            yield

    def moves(self) -> None:
        until(lambda: self.rig.ticks == DRIVEN, "the command on the chip")

    @property
    def at_rest(self) -> bool:
        return self.rig.ticks == NEUTRAL

    def rests(self) -> None:
        until(lambda: self.at_rest, "neutral")

    def stays_neutral(self, seconds: float = 0.5) -> None:
        for _ in every(0.002, round(seconds * 500)):
            assert self.rig.ticks == NEUTRAL

    @property
    def stop_file(self) -> Path:
        return Path(self.rig.environment["XDG_STATE_HOME"]) / f"zteleop/robots/{self.rig.robot}/stop"

    def is_latched(self, by: str) -> None:
        """A stop by somebody is in the file, and shown to everybody."""
        until(lambda: self.kept, "a stop in the file")
        assert self.kept["by"] == by
        hear(
            self.statuses,
            lambda status: self.kept["id"] in [stop.id for stop in status.stops],
            "the stop in drive_status",
        )

    @property
    def kept(self) -> dict[str, object]:
        """The stop in the file; nothing while it is being written."""
        with suppress(FileNotFoundError, ValueError):
            self.last = json.loads(self.stop_file.read_text())[-1]
        return self.last

    def press_stop(self) -> None:
        self.node.publisher("stop", Stop).publish(Stop(True, new_id(), "the test", ""))


def defective(rig: Rig, defect: str) -> Bench:
    program = ACTUATOR.format(defect=defect)
    bus = ["--no-multicast-scouting", "--listen", rig.endpoint]
    watchdog = rig.program(START, program, "--robot", rig.robot, *bus)
    watchdog.says("obeys")
    return Bench(rig, watchdog)
