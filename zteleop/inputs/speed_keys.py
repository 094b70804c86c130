"""How fast a full stick is, by keys that change it by a tenth."""

from msgspec.structs import replace

from zteleop.control.stick import Speeds
from zteleop.messages import Vehicle

FASTER, SLOWER = 1.1, 0.9
SLOWEST, FASTEST = 0.01, 100.0
"""m/s or rad/s between which keys move a speed, so that it is never stuck at zero."""


class SpeedKeys:
    """Speeds in m/s and rad/s, never above what the robot can."""

    def __init__(self, speeds: Speeds) -> None:
        self.speeds = speeds
        self._fastest = Speeds(FASTEST, FASTEST)

    def fit(self, vehicle: Vehicle) -> None:
        """Learn what the robot can."""
        self._fastest = Speeds(vehicle.max_speed, vehicle.max_turn)
        self.scale()

    def scale(self, forward: float = 1.0, turn: float = 1.0) -> None:
        """Change both by a factor."""
        self.speeds = replace(
            self.speeds,
            forward=min(max(self.speeds.forward * forward, SLOWEST), self._fastest.forward),
            turn=min(max(self.speeds.turn * turn, SLOWEST), self._fastest.turn),
        )
