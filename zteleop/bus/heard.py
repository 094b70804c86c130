"""What a node hears of a robot that it commands."""

import time

from zteleop.bus import clock
from zteleop.bus.subscription import Subscription
from zteleop.messages import Beat, Vehicle

PATIENCE = 1.0
_POLL = 0.002


class Heard:
    """The robot's newest beat, which proofs echo, and what it says of itself."""

    def __init__(self, beats: Subscription[Beat], vehicles: Subscription[Vehicle]) -> None:
        self._beats, self._vehicles = beats, vehicles
        self._vehicle: Vehicle | None = None
        self._patience = PATIENCE
        self.beat: Beat | None = None
        self.at = float("-inf")
        """When the beat was heard, by the bus clock."""

    @property
    def vehicle(self) -> Vehicle | None:
        self._vehicle = self._vehicles.newest() or self._vehicle
        return self._vehicle

    def wait(self) -> None:
        """Wait, once, for the first beat and for the vehicle.

        What moves before a beat would have begun before the robot; neutral pulses are the vehicle's own.
        """
        give_up = clock.now() + self._patience
        self._patience = 0.0
        while (self.beat is None or self.vehicle is None) and clock.now() < give_up:
            self.listen()
            time.sleep(_POLL)

    def listen(self) -> None:
        """Take in the beat that arrived last."""
        beat = self._beats.newest()
        if beat:
            self.beat, self.at = beat, clock.now()
