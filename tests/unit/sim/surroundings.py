"""Surroundings that a test makes up: what touches the body, where there is no floor, and a dock."""

from collections.abc import Sequence


class Around:
    def __init__(
        self,
        contacts: Sequence[float] = (),
        holes: Sequence[tuple[float, float]] = (),
        dock: tuple[float, float, float] | None = None,
    ) -> None:
        self.contacts, self._holes, self._dock = contacts, holes, dock

    def is_floor(self, ahead: float, left: float) -> bool:
        return (ahead, left) not in self._holes

    def distance(self, ahead: float, left: float, bearing: float, longest: float) -> float:
        return longest

    def dock(self) -> tuple[float, float, float] | None:
        return self._dock
