"""One subscription of zenoh's for each key, however many of the robot's own processes hear it.

zenoh would hand each of them the sample in turn, made into Python anew. Here it is made once, and passed
first to who keeps the fewest: he acts on the newest, and the others only look.
"""

from collections.abc import Callable

from zteleop.bus.session import Sample, Undeclarable
from zteleop.bus.zenoh_session import ZenohSession

Passes = Callable[[Sample], None]


class Hub:
    """Shares out what is said; `hear`, and what it returns, are for one thread alone."""

    def __init__(self, session: ZenohSession) -> None:
        self._session = session
        self._channels: dict[str, Channel] = {}

    def hear(self, key: str, depth: int, passes: Passes) -> "Ear":
        """Call `passes` in a thread of zenoh's for what is said; raises BusError for a key that is none."""
        channel = self._channels.get(key) or Channel()
        ear = Ear(depth, passes, lambda: self._leave(key, ear))
        channel.add(ear)
        if channel.declared is None:
            channel.declared = self._session.hear(key, channel.share)
            self._channels[key] = channel
        return ear

    def _leave(self, key: str, ear: "Ear") -> None:
        channel = self._channels[key]
        channel.remove(ear)
        if not channel.ears and channel.declared:
            del self._channels[key]
            channel.declared.undeclare()


class Ear:
    """One who hears a key, until it is undeclared."""

    def __init__(self, depth: int, passes: Passes, leave: Callable[[], None]) -> None:
        self.depth = depth
        self.passes = passes
        self._leave = leave

    def undeclare(self) -> None:
        """Hear no more."""
        self._leave()


class Channel:
    """Those who hear one key."""

    def __init__(self) -> None:
        self.ears: tuple[Ear, ...] = ()
        """never changed, only replaced: zenoh's thread goes through it meanwhile"""
        self.declared: Undeclarable | None = None

    def add(self, ear: Ear) -> None:
        self.ears = tuple(sorted((*self.ears, ear), key=lambda one: one.depth))

    def remove(self, ear: Ear) -> None:
        self.ears = tuple(one for one in self.ears if one is not ear)

    def share(self, sample: Sample) -> None:
        """Pass a sample on to each of them."""
        for ear in self.ears:
            ear.passes(sample)
