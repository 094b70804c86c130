"""A robot for a `FakeNode`, in its time: it obeys what a program says, moves, and says where it is.

Commands pass the same gate, limits, mixer and servos as on a real one, and pulses move the same bodies as in
`zteleop sim`; a minute of it takes a second, and is the same each time.
"""

from random import Random

from zteleop.control.command import moves, neutral, to_command
from zteleop.control.drive import Drive, Step
from zteleop.control.motion.pose import Pose2D
from zteleop.control.proof import Prover
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.control.vehicles import VEHICLES
from zteleop.messages import Header, Message, Time, Twist, Vehicle
from zteleop.sim import make_vehicle
from zteleop.sim.noise import NONE, Noise
from zteleop.sim.odometer import Odometer
from zteleop.sim.ranges import RangeSensor
from zteleop.sim.scene import Scene
from zteleop.sim.world import World
from zteleop.testing.node import FakeNode, Said

TICK_US = 4.08
"""of a PCA9685 at 60 Hz"""
STEP, SAID, RANGED = 0.02, 0.05, 0.1
"""s between two steps of the robot, and between what it says of where it is, and of what is ahead"""


class SimulatedRobot:
    """Obeys `cmd_vel` and `pwm`, and says `odom`; in a scene also `range`.

    `vehicle` is car, tank or create3. Raises ConfigError for a scene in which it does not fit.
    """

    def __init__(
        self,
        node: FakeNode,
        vehicle: str = "car",
        scene: Scene | None = None,
        *,
        noise: Noise = NONE,
        seed: int = 0,
    ) -> None:
        built = VEHICLES[vehicle]
        settings = DriveSettings(mixer=built.mixer, servos=built.servos, limits=built.limits)
        clock = node.loop.clock
        self._node = node
        self._drive = Drive(settings, TICK_US, 1, clock.time - STEP)  # it has started when the test begins
        self._body = make_vehicle(settings.mixer, settings.servos)
        self._body.odometer = Odometer(noise, Random(seed))
        self._noise = noise
        self._chance = Random(seed)
        self._world = World(scene, self._body.discs) if scene else None
        self._body.room = self._world
        known = to_vehicle(settings, TICK_US)
        self._listeners = {name: Listener(number, known) for number, name in enumerate(("cmd_vel", "pwm"), 1)}
        self._then = clock.time
        self.step: Step = self._drive.step(clock.time)
        """what it does, and why"""
        node.hear_beat(vehicle=known)
        node.loop.every(STEP, self._move)
        node.loop.every(SAID, self._tell)
        if self._world:
            node.loop.every(RANGED, self._look)

    @property
    def pose(self) -> Pose2D:
        """Where it really is, m and rad; its odometry may err."""
        return self._body.pose

    @property
    def speed(self) -> float:
        """m/s"""
        return self._body.speed

    @property
    def distance(self) -> float:
        """m rolled since the start, back and forth"""
        return self._body.distance

    @property
    def stands_at(self) -> str:
        """What of the scene it has run into, such as walls[0]; empty while it has not."""
        contact = self._world.contact if self._world else None
        return contact.name if contact else ""

    def _move(self) -> None:
        now = self._node.loop.clock.time
        for topic, listener in self._listeners.items():
            if said := self._node.said.get(topic):
                listener.hear(said, self._drive, now)
        self.step = self._drive.step(now)
        self._body.step(dict(self.step.pulse_us), now - self._then)
        self._then = now

    def _tell(self) -> None:
        if "odom" in self._node.inboxes:
            self._node.hear("odom", self._body.odometry(self._stamp()))

    def _look(self) -> None:
        if self._world and "range" in self._node.inboxes:
            sensor = RangeSensor()
            ahead = sensor.measure(self._world, self._world.nose)
            header = Header(self._stamp(), "range")
            self._node.hear("range", sensor.state(header, ahead, self._chance, self._noise.range))

    def _stamp(self) -> Time:
        sec, part = divmod(self._node.loop.clock.time, 1.0)
        return Time(int(sec), int(part * 1e9))


class Listener:
    """Takes what was said on one topic of a fake node to a drive, with the proof that it is new."""

    def __init__(self, sender: int, vehicle: Vehicle) -> None:
        self._prover = Prover(sender)
        self._vehicle = vehicle
        self._kept: list[Message] = []
        self._heard = 0
        """of those kept"""
        self._acts = 0
        self._lets_go = 0

    def hear(self, said: Said, drive: Drive, now: float) -> None:
        """Hear the newest, if there is one since; a test may have taken what was said before."""
        if said.acts != self._acts:
            self._acts = said.acts
            self._prover.act(drive.admission.beat(now))
        if said.messages is not self._kept:
            self._kept, self._heard = said.messages, 0
        new = said.messages[self._heard :]
        self._heard = len(said.messages)
        if new:
            self._receive(said, new[-1], drive, now)
        if said.lets_go != self._lets_go:
            self._lets_go = said.lets_go
            self._prover.let_go()
            kind = type(said.messages[-1]) if said.messages else Twist
            if rest := neutral(kind, self._vehicle):
                self._receive(said, rest, drive, now)

    def _receive(self, said: Said, message: Message, drive: Drive, now: float) -> None:
        source, beat = said.topic.partition("/")[2], drive.admission.beat(now)
        proof = self._prover.prove(beat, moves(message, self._vehicle), now)
        said.refused = drive.receive(source, to_command(message), proof, now) or ""
