"""Pages that look at something of the bus, which is heard for as long as one of them does."""

from collections.abc import Iterator

from zteleop.bridges.web.slots import Frame, Slots
from zteleop.bus.session import Overheard, Sample, Session


class Lookers:
    """For the node's loop alone; of a flood the oldest samples are lost."""

    def __init__(self, session: Session, key: str, depth: int) -> None:
        self._session = session
        self._key = key
        self._depth = depth
        self._pages: dict[str, Slots] = {}
        self._ring: Overheard | None = None

    def __bool__(self) -> bool:
        return bool(self._pages)

    def look(self, page: str, slots: Slots) -> None:
        """Let a page look from now on."""
        self._pages[page] = slots
        self._ring = self._ring or self._session.overhear(self._key, self._depth)

    def forget(self, page: str) -> None:
        """Take in that a page looks no longer, or is gone."""
        self._pages.pop(page, None)
        if self._ring and not self._pages:
            self._ring.undeclare()
            self._ring = None

    def take(self) -> Iterator[Sample]:
        """Yield what was heard since the last time; no more at once than fits: this loop drives as well."""
        for _ in range(self._depth):
            if self._ring is None or (sample := self._ring.try_recv()) is None:
                return
            yield sample

    def tell(self, kind: str, frame: Frame) -> None:
        """Tell all who look."""
        for slots in self._pages.values():
            slots.put(kind, frame)
