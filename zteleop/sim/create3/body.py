"""An iRobot Create 3 as its wheels move it: softly, and backwards no farther than it knows the floor."""

from collections.abc import Mapping

from zteleop.control.create3 import ACCELERATION, SAFE_SPEED
from zteleop.control.servo import Servo
from zteleop.sim.body import Body, Disc, Pulses
from zteleop.sim.create3.backup import BackupLimit
from zteleop.sim.create3.hazards import BACKUP_LIMIT, Hazard
from zteleop.sim.create3.wheels import STILL, Wheels
from zteleop.sim.esc import fraction

RADIUS = 0.171
"""m"""
ROUNDING = 0.005
"""of a wheel's full speed: half a tick of a chip at 60 Hz is 2 us of 500"""


class Create3(Body):
    """A pulse asks a wheel for a share of what its safety allows; without one, or at rest, it brakes.

    `full_speed`, m/s, is above `SAFE_SPEED` where its safety is overridden: then nothing limits how far it
    reverses.
    """

    def __init__(self, servos: Mapping[str, Servo], full_speed: float = SAFE_SPEED) -> None:
        super().__init__()
        self.discs = (Disc(0.0, RADIUS),)
        self.wheels = Wheels()
        self.backup = BackupLimit()
        self._servos = servos["left"], servos["right"]
        self._full_speed = full_speed

    def move(self, pulse_us: Pulses, dt: float) -> None:
        """Turn both wheels towards what their pulses ask for."""
        left, right = (self._full_speed * self._share(servo, pulse_us) for servo in self._servos)
        back = left + right < -2 * ROUNDING * SAFE_SPEED and self._full_speed <= SAFE_SPEED
        if back:
            self.backup.reverse()
        blocked = back and self.backup.is_reached
        self.wheels.turn(STILL if blocked else (left, right), ACCELERATION, dt)
        self.speed, self.yaw_rate = self.wheels.speed, self.wheels.yaw_rate

    def went(self, way: float, turn: float, dt: float) -> None:
        super().went(way, turn, dt)
        self.wheels.roll(dt)
        self.backup.roll(way)

    def halt(self) -> None:
        super().halt()
        self.wheels.halt()

    def _share(self, servo: Servo, pulse_us: Pulses) -> float:
        """Return what a pulse asks for, -1 to 1; nothing where only a chip's rounding makes it any."""
        share = fraction(servo, pulse_us.get(servo.channel)) or 0.0
        return share if abs(share) > ROUNDING else 0.0

    @property
    def hazards(self) -> list[Hazard]:
        """What hinders it by itself: it was told to reverse farther than it may."""
        return [Hazard(BACKUP_LIMIT, "base_link")] if self.backup.ignored else []
