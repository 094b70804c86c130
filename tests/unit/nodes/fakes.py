"""A stop file without a file, and one of limits."""

from collections.abc import Iterable, Mapping

from zteleop.errors import DeviceError
from zteleop.messages import Stop


class Shelf:
    """Keeps stops, unless a test says that it cannot."""

    def __init__(self, *stops: Stop) -> None:
        self.stops = list(stops)
        self.past = 0
        self.unkept = ""
        self.full = self.stuck = False
        """Nothing more can be kept, or removed."""

    @property
    def stop(self) -> Stop | None:
        return self.stops[-1] if self.stops else None

    def exists(self) -> bool:
        return bool(self.stops)

    def load(self) -> list[Stop]:
        return list(self.stops)

    def ids(self) -> frozenset[int]:
        return frozenset(stop.id for stop in self.stops)

    def promise(self, stops: Iterable[Stop]) -> None:
        self.promised, self.unkept = list(stops), "they are being written"

    def keep(self, stops: Iterable[Stop]) -> None:
        self.promise(stops)
        self.tend()

    def tend(self) -> None:
        if self.unkept:
            self.stops = self.stops if self.full else self.promised
            self.unkept = "no space left" if self.full else ""

    def add(self, stop: Stop) -> None:
        self.keep([*self.stops, stop])

    def released(self) -> int:
        return self.past

    def release(self, said: Stop, rest: Iterable[Stop]) -> bool:
        self.stops = self.stops if self.stuck else list(rest)
        return not self.stuck

    def remove(self) -> None:
        """Do what somebody does by hand."""
        self.stops = []


class LimitsShelf:
    """Keeps limits, unless a test says that it cannot."""

    def __init__(self, values: Mapping[str, float] | None = None) -> None:
        self.values = dict(values or {})
        self.full = self.torn = False
        """Nothing can be kept, or read."""

    def load(self) -> dict[str, float]:
        if self.torn:
            raise DeviceError("it is no list of limits")
        return dict(self.values)

    def keep(self, values: dict[str, float]) -> None:
        if self.full:
            raise DeviceError("no space left")
        self.values = dict(values)
