"""A link that loses, doubles and reorders what it carries, by count: the same each time."""

from typing import Generic, TypeVar

T = TypeVar("T")


class Link(Generic[T]):
    """Drops, repeats, or holds back behind the next, each so-many-th thing it is given; 0 is none."""

    def __init__(self, *, drop: int = 0, repeat: int = 0, swap: int = 0) -> None:
        self._drop = drop
        self._repeat = repeat
        self._swap = swap
        self._count = 0
        self._held: list[T] = []

    def carry(self, thing: T) -> list[T]:
        """Return what comes out when a thing goes in."""
        self._count += 1
        if self._is_each(self._swap):
            self._held.append(thing)
            return []
        out = [] if self._is_each(self._drop) else [thing] * (2 if self._is_each(self._repeat) else 1)
        return out + self.flush()

    def flush(self) -> list[T]:
        """Return what is held back still."""
        held = self._held
        self._held = []
        return held

    def _is_each(self, number: int) -> bool:
        return number > 0 and self._count % number == 0
