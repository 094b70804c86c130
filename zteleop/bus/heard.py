"""What a node hears of a robot that it commands."""

import time

from zteleop.bus import clock
from zteleop.bus.subscription import Subscription
from zteleop.control.proof import NEVER
from zteleop.messages import Beat, Refusals, Vehicle

HEARD_WITHIN, START = 1.0, 6.0
"""s for the robot to be heard, and then for its start to be over."""
_POLL = 0.002


class Heard:
    """The robot's newest beat, which proofs echo, and what it says of itself."""

    def __init__(
        self, beats: Subscription[Beat], vehicles: Subscription[Vehicle], refusals: Subscription[Refusals]
    ) -> None:
        self._beats = beats
        self._vehicles = vehicles
        self._refusals = refusals
        self._waited = False
        self.beat: Beat | None = None
        self.vehicle: Vehicle | None = None
        self.at = NEVER
        """When the beat was heard, by the bus clock."""
        self.listened = NEVER
        """When it was last listened for."""
        self.refusals: Refusals | None = None
        """Whom the robot last said it refuses."""

    @property
    def there(self) -> bool:
        """Beat and vehicle have been heard."""
        return self.beat is not None and self.vehicle is not None

    @property
    def ready(self) -> bool:
        """It is there, and its start is over."""
        return self.beat is not None and self.vehicle is not None and self.vehicle.ready

    def wait(self) -> bool:
        """Wait, once, for the robot to be heard, and while it starts; True when it is there.

        What moves before a beat, or before the start is over, would have begun too early to drive it.
        """
        began, self._waited = (NEVER if self._waited else clock.now()), True
        self.listen()
        while not self.ready and clock.now() - began < (START if self.there else HEARD_WITHIN):
            time.sleep(_POLL)
            self.listen()
        return self.there

    def listen(self) -> None:
        """Take in what arrived last."""
        self.vehicle = self._vehicles.newest() or self.vehicle
        beat, self.listened = self._beats.newest(), clock.now()
        if beat:
            self.beat, self.at = beat, self.listened

    def listen_for_refusals(self) -> None:
        """Take in whom the robot refuses; proves nothing, so it may be heard at any time."""
        self.refusals = self._refusals.newest() or self.refusals
