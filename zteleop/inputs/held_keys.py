"""Which keys are down on a terminal that tells of presses and repeats, never of releases.

Only the newest key repeats, so its repeats speak for the key of the other axis that was down before it.
"""

from collections.abc import Mapping

from zteleop.control.stick import Stick
from zteleop.inputs.keymap import Moves
from zteleop.inputs.levers import Axis

FIRST = 0.6
"""s that a first press counts, until repeats may begin."""
SHORTEST_GAP, LONGEST_GAP = 0.12, 0.3
"""s after the last repeat until a key counts as let go."""
TOLD_FOR = 3.0
"""s that a press in vain is worth a word, unless one counts before"""
HELD_BEFORE = f"this key counts as held since before: let go for {FIRST} s, then press it again"
REPEATING = 0.1
"""s; no finger taps faster than this, so shorter intervals are repeats."""


class HeldKeys:
    """What is held now."""

    def __init__(self) -> None:
        self.confirmed = False
        """A repeat has told that the throttle is held; until then it may have been a touch."""
        self._axes: dict[Axis, int] = {}
        self._newest = ""
        self._count = 0
        self._seen = 0.0
        self._until = 0.0
        self._interval = 0.0

    @property
    def gap(self) -> float:
        """s that a repeat counts, by the interval measured."""
        return min(LONGEST_GAP, max(SHORTEST_GAP, 3 * self._interval))

    def press(self, key: str, moves: Moves, now: float) -> None:
        """Take in a press or a repeat; the last pressed of one axis wins."""
        alive = now < self._until
        if not alive:
            self._axes.clear()
        pushes = dict(moves).get("throttle")
        if not alive or pushes not in (None, self._axes.get("throttle")):
            self.confirmed = False
        if alive and key == self._newest:
            self._repeat(now)
        else:
            self._newest, self._count, self._until = key, 0, now + FIRST
        self._axes.update(moves)
        self._seen = now

    def clear(self) -> None:
        """Count every key as let go."""
        self._axes.clear()
        self._until, self._newest = 0.0, ""

    def stick(self, now: float) -> Stick:
        """Return what the held keys ask for; nobody holds it when none is."""
        if now >= self._until:
            return Stick()
        return pushed(self._axes)

    def _repeat(self, now: float) -> None:
        self.confirmed = True  # also of the key of the other axis, for which it speaks
        interval, self._count = now - self._seen, self._count + 1
        if self._count > 1:
            self._interval += (interval - self._interval) / 4 if self._interval else interval
        lapse = now + self.gap
        # the first press's allowance ends as soon as repeats are there to speak for the key
        self._until = lapse if self._count > 1 and interval <= REPEATING else max(self._until, lapse)


def pushed(axes: Mapping[Axis, int]) -> Stick:
    """Return the stick of somebody who pushes these axes all the way."""
    return Stick(float(axes.get("throttle", 0)), float(axes.get("steering", 0)), deadman=True)


class Block:
    """Keys that were down at a reset; their repeats move nothing until they have been quiet for FIRST."""

    def __init__(self) -> None:
        self._seen: dict[str, float] = {}
        self._blocked: dict[str, float] = {}

    def passes(self, key: str, now: float) -> bool:
        """Return whether a key may act; one that may not stays blocked for longer."""
        self._seen[key] = now
        since = self._blocked.pop(key, None)
        if since is None or now - since >= FIRST:
            return True
        self._blocked[key] = now
        return False

    def block(self, now: float) -> None:
        """Block every key that may still be down."""
        self._blocked |= {key: now for key, seen in self._seen.items() if now - seen < FIRST}

    def is_felt(self, now: float) -> bool:
        """Say whether a key was pressed just now in vain."""
        return any(at == self._seen[key] and now - at < TOLD_FOR for key, at in self._blocked.items())
