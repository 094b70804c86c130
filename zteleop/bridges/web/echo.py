"""The beat that a page has heard, for the proofs of what is said on its behalf.

The page hears the robot's beats by way of this server and gives the newest back with what it holds: so a
proof says how old the page's word is, and not how young the server's ears are. It can say no younger one
than was ever said here.
"""

from collections.abc import Callable

from msgspec.structs import replace

from zteleop.bridges.web.words import Held
from zteleop.bus.heard import Hears
from zteleop.messages import Beat, Vehicle


class Echo:
    """What a publisher hears of its robot, but for the beat, which is the page's."""

    def __init__(self, heard: Hears, said: Callable[[], Held]) -> None:
        self._heard = heard
        self._said = said

    @property
    def beat(self) -> Beat | None:
        """The newest that the page gave back; None where it is of another start, or of none."""
        newest, said = self._heard.beat, self._said()
        if newest is None or said.epoch != newest.epoch:
            return None
        return replace(newest, time=min(said.beat, newest.time))

    @property
    def vehicle(self) -> Vehicle | None:
        """What the robot last said it is."""
        return self._heard.vehicle

    @property
    def awake_since(self) -> float:
        """When this process last woke from standing still."""
        return self._heard.awake_since
