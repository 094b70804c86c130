"""A vehicle that does at once, and every 50 ms, what a course asks for; no bus, no clock."""

from collections.abc import Callable

from zteleop.control.mixer import Differential
from zteleop.control.motion.pose import Pose2D
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.messages import Twist, Vehicle
from zteleop.sim import make_vehicle

CAR = DriveSettings()
TANK = DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)})
PERIOD = 0.05


class Robot:
    """A simulated vehicle, told by the pulses of its servos."""

    def __init__(self, settings: DriveSettings, pose: Pose2D | None = None) -> None:
        self._settings = settings
        self.body = make_vehicle(settings.mixer, settings.servos)
        self.body.x, self.body.y, self.body.heading = pose or Pose2D()
        self.seconds = 0.0
        self.trail: list[Pose2D] = [self.pose]
        self.obey(Twist.zero(), 3.0)

    @property
    def vehicle(self) -> Vehicle:
        return to_vehicle(self._settings, 4.08)

    @property
    def pose(self) -> Pose2D:
        return Pose2D(self.body.x, self.body.y, self.body.heading)

    def obey(self, twist: Twist, seconds: float = PERIOD) -> None:
        servos, wheels = self._settings.servos, self._settings.mixer.mix(twist)
        pulses = {servos[name].channel: servos[name].pulse_us(part) for name, part in wheels.items()}
        for _ in range(round(seconds / PERIOD)):
            self.body.step(pulses, PERIOD)
        self.trail.append(self.pose)

    def drive(self, twist: Callable[[Pose2D, float], Twist | None], patience: float = 90.0) -> None:
        """Drive to the end of a course, and to rest."""
        while wanted := twist(self.pose, self.seconds):
            self.obey(wanted)
            self.seconds += PERIOD
            assert self.seconds < patience, f"no end in {patience} s, at {self.pose}"
        self.obey(Twist.zero(), 2.0)
