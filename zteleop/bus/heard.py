"""What a node hears of a robot that it commands."""

import time
from collections.abc import Callable
from typing import Protocol

from zteleop.bus import clock
from zteleop.bus.subscription import Subscription
from zteleop.control.proof import NEVER
from zteleop.messages import Beat, Refusals, Vehicle

HEARD_WITHIN, START = 10.0, 16.0
"""s for the robot to be heard, and for its start to be over as well: who starts both does so in any order"""
TELL_AFTER = 1.0
"""s of that until it is told for whom somebody waits"""
_POLL = 0.002


class Hears(Protocol):
    """What the proofs of a command are made from."""

    @property
    def beat(self) -> Beat | None:
        """The newest that was heard by whoever acts."""

    @property
    def vehicle(self) -> Vehicle | None:
        """What the robot last said it is."""

    @property
    def awake_since(self) -> float:
        """When this process last woke from standing still; before that it heard, and said, nothing."""


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
        self.awake_since = NEVER
        """When this process last woke from standing still; before that it heard, and said, nothing."""
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

    def wait(self, tell: Callable[[], object]) -> bool:
        """Wait, once, for the robot to be heard, and while it starts; True when it is there.

        Of one that is not there soon, `tell`.
        What moves before a beat, or before the start is over, would have begun too early to drive it.
        """
        began, self._waited = (NEVER if self._waited else clock.now()), True
        told = False
        self.listen()
        while not self.ready and (waited := clock.now() - began) < (START if self.there else HEARD_WITHIN):
            if not told and not self.there and waited > TELL_AFTER:
                told = True
                tell()
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
