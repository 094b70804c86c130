"""What waits for a process: of each kind in turn, so that a flood of one holds up no other."""

from collections import deque
from collections.abc import Hashable
from typing import Generic, TypeVar

T = TypeVar("T")


class Backlog(Generic[T]):
    """A queue for each kind, of at most so many bytes together, but for one item of each."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._queues: dict[Hashable, deque[tuple[T, int]]] = {}
        """The kind whose turn it is stands first."""
        self._bytes = 0

    def __bool__(self) -> bool:
        return bool(self._queues)

    def has(self, kind: Hashable) -> bool:
        """Say whether something of a kind waits."""
        return kind in self._queues

    def add(self, kind: Hashable, item: T, size: int) -> None:
        """Let an item wait behind those of its kind; of a kind that waits it is lost where too much does."""
        if self._bytes < self._most or kind not in self._queues:
            self._queues.setdefault(kind, deque()).append((item, size))
            self._bytes += size

    @property
    def next(self) -> T:
        """The item whose turn it is."""
        return next(iter(self._queues.values()))[0][0]

    def drop(self) -> None:
        """Drop that item, and give the turn to another kind."""
        kind, queue = next(iter(self._queues.items()))
        self._bytes -= queue.popleft()[1]
        del self._queues[kind]
        if queue:
            self._queues[kind] = queue
