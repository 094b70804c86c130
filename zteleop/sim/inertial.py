"""What an inertial unit on a body feels: how it turns, how it is pushed, and which way it looks by now.

Axes of base_link (REP-145): at rest it feels gravity as an acceleration upwards.
"""

from random import Random

from zteleop.control.motion.pose import turned_by
from zteleop.messages import Header, Imu, Vector3
from zteleop.sim.body import Body
from zteleop.sim.noise import NONE, Noise

GRAVITY = 9.81
"""m/s^2"""


class Inertial:
    """One unit; its heading is the body's own, and so does not drift as that of wheels does."""

    def __init__(self, noise: Noise = NONE, chance: Random | None = None) -> None:
        self._noise = noise
        self._chance = chance or Random(0)
        self._speed = 0.0

    def measure(self, header: Header, body: Body, dt: float) -> Imu:
        """Return what it feels after `dt` s of what it felt before."""
        ahead = (body.speed - self._speed) / dt if dt > 0 else 0.0
        self._speed = body.speed
        gyro, wrong = self._noise.gyro, self._chance.gauss(0, self._noise.gyro) if self._noise.gyro else 0.0
        return Imu(
            header,
            turned_by(body.heading),
            _diagonal(gyro**2),
            Vector3(0.0, 0.0, body.yaw_rate + wrong),
            _diagonal(gyro**2),
            Vector3(ahead, body.speed * body.yaw_rate, GRAVITY),
            _diagonal(0.0),
        )


def _diagonal(variance: float) -> list[float]:
    """Return a covariance of three values that are wrong by as much each, and by themselves."""
    return [variance, 0.0, 0.0, 0.0, variance, 0.0, 0.0, 0.0, variance]
