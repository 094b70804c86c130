"""Stops that add up: anybody engages one, and each stays until it is released by its own name."""

from collections import OrderedDict
from collections.abc import Iterable, Sequence

from zteleop.messages import Stop

REMEMBERED = 64
"""How many past stops and releases are known by id; what a network delivers late of them changes nothing."""
PRESSERS = 64
"""How many stops are kept apart, one of each presser; those of all others are one, under no person's name."""
MERGED = Stop(engaged=True, id=2**53 - 1, by="others", why=f"more than {PRESSERS} people press stop")
RELEASE = "zteleop stop --release"
"""What a shell says to release a stop; a screen has a key for it."""
TOLD = 3
"""How many of them words name"""


class Latch:
    """Holds every stop in force, the oldest first; the robot is free when there is none."""

    def __init__(self, stops: Iterable[Stop] = ()) -> None:
        self.released = 0
        """The id of the last stop that was released; one that has none counts on from the one before."""
        self._stops: dict[str, Stop] = {}
        self._known: OrderedDict[int, None] = OrderedDict()
        for stop in stops:
            self.obey(stop)

    @property
    def stops(self) -> tuple[Stop, ...]:
        return tuple(self._stops.values())

    def obey(self, said: Stop) -> bool:
        """Engage or release; True when that changed anything."""
        return self._engage(said) if said.engaged else self._release(said)

    def forget(self, ids: Iterable[int]) -> None:
        """End stops by other means than their release."""
        for identity in ids:
            self._drop(identity)

    def without(self, identity: int) -> list[Stop]:
        """Return what would still be in force without the stop of that id."""
        return [stop for stop in self._stops.values() if stop.id != identity]

    def _engage(self, said: Stop) -> bool:
        """Add a stop; a new one of the same presser takes the place of the old."""
        if said.id in self._known or any(stop.id == said.id for stop in self._stops.values()):
            return False
        self._know(said.id)
        if said.by == MERGED.by or (said.by not in self._stops and len(self._stops) >= PRESSERS):
            said = MERGED  # nobody can press by that name, and so end what others have pressed
        self._stops[said.by] = said
        return True

    def _release(self, said: Stop) -> bool:
        """End the stop of that id; the end of one that was never heard is news as well."""
        if not self._drop(said.id) and said.id in self._known:
            return False
        self._know(said.id)
        self.released = said.id or (self.released + 1) % 2**53
        return True

    def _drop(self, identity: int) -> bool:
        found = [by for by, stop in self._stops.items() if stop.id == identity]
        for by in found:
            del self._stops[by]
        return bool(found)

    def _know(self, identity: int) -> None:
        if identity:  # 0 is nobody's: a person who says it by hand means it each time
            self._known[identity] = None
        if len(self._known) > REMEMBERED:
            self._known.popitem(last=False)


def is_persons(stop: Stop) -> bool:
    """Say whether a stop bears a person's name, as user@host; any other is nobody's own to release."""
    return "@" in stop.by


def whose(stops: Sequence[Stop]) -> str:
    """Return whose stops these are, and why, in words."""
    named = [f"{stop.by or 'somebody'}{f' ({stop.why})' if stop.why else ''}" for stop in stops[:TOLD]]
    if len(stops) > TOLD:
        named.append(f"{len(stops) - TOLD} more")
    return " and ".join([", ".join(named[:-1]), named[-1]] if len(named) > 1 else named)


def stopped_by(stops: Sequence[Stop]) -> str:
    """Return the stops in force in words."""
    if len(stops) == 1:
        who, why = stops[0].by or "somebody", f": {stops[0].why}" if stops[0].why else ""
        return f"stopped by {who}{why}; {RELEASE}, then begin from neutral"
    return f"stopped by {whose(stops)}; each releases their own, then begin from neutral"
