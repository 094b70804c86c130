"""A stop that stays: engaged by anybody, released only by its own name."""

from collections import OrderedDict

from zteleop.messages import Stop

REMEMBERED = 64
"""How many past stops and releases are known by id; what a network delivers late of them changes nothing."""


class Latch:
    """Holds the newest stop; `stop` is None when there is none."""

    def __init__(self, stop: Stop | None = None) -> None:
        self.stop: Stop | None = None
        self.released = 0
        """The id of the last stop that was released; one that has none counts on from the one before."""
        self._known: OrderedDict[int, None] = OrderedDict()
        if stop:
            self.obey(stop)

    def obey(self, said: Stop) -> bool:
        """Engage or release; True when that changed anything."""
        return self._engage(said) if said.engaged else self._release(said)

    def forget(self) -> None:
        """End the stop by other means than its release."""
        self.stop = None

    def _engage(self, said: Stop) -> bool:
        if said.id in self._known or (self.stop and self.stop.id == said.id):
            return False
        self._know(said.id)
        self.stop = said
        return True

    def _release(self, said: Stop) -> bool:
        """End the stop in force; the end of one that was never heard is news as well."""
        if self.stop and said.id != self.stop.id:
            return False
        if self.stop is None and said.id in self._known:
            return False
        self._know(said.id)
        self.released = said.id or (self.released + 1) % 2**53
        self.stop = None
        return True

    def _know(self, identity: int) -> None:
        if identity:  # 0 is nobody's: a person who says it by hand means it each time
            self._known[identity] = None
        if len(self._known) > REMEMBERED:
            self._known.popitem(last=False)


def describe(stop: Stop) -> str:
    """Return a stop in words."""
    reason = f": {stop.why}" if stop.why else ""
    return f"stopped by {stop.by or 'somebody'}{reason}; zteleop stop --release, then begin from neutral"
