"""What a node hears of a robot that it commands."""

from zteleop.bus import clock
from zteleop.bus.subscription import Subscription
from zteleop.messages import Beat, Vehicle


class Heard:
    """The robot's newest beat, which proofs echo, and what it says of itself."""

    def __init__(self, beats: Subscription[Beat], vehicles: Subscription[Vehicle]) -> None:
        self._beats, self._vehicles = beats, vehicles
        self._vehicle: Vehicle | None = None
        self.beat: Beat | None = None
        self.at = float("-inf")
        """When the beat was heard, by the bus clock."""

    @property
    def vehicle(self) -> Vehicle | None:
        self._vehicle = self._vehicles.newest() or self._vehicle
        return self._vehicle

    def listen(self) -> None:
        """Take in the beat that arrived last."""
        beat = self._beats.newest()
        if beat:
            self.beat, self.at = beat, clock.now()
