"""What a body can feel of its scene, seen from base_link: x ahead, y to the left."""

from collections.abc import Sequence
from typing import Protocol


class Surroundings(Protocol):
    @property
    def contacts(self) -> Sequence[float]:
        """Bearings, in rad, of what touches the body now."""

    def is_floor(self, ahead: float, left: float) -> bool:
        """Say whether there is floor at that place."""

    def distance(self, ahead: float, left: float, bearing: float, longest: float) -> float:
        """Return the m from that place to the nearest wall or obstacle along a bearing; at most `longest`."""

    def dock(self) -> tuple[float, float, float] | None:
        """Return ahead, left and bearing of where a docked robot stands and looks; None without a dock."""
