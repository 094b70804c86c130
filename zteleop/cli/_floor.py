"""What a simulated robot drives in, as its simulator says it: for the picture."""

from collections.abc import Sequence

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.control.proof import NEVER
from zteleop.errors import ConfigError
from zteleop.messages import String
from zteleop.screen.top_view import Mark

LASTS = 3.0
"""s, of three times that it is said, after which it is so no more"""


class Floor:
    """The scene of a robot, while somebody says it; a stranger's is bounded, and costs a picture no time."""

    def __init__(self, node: Node) -> None:
        self._log = node.log
        self._scenes = node.subscription("scene", String)
        self._text = ""
        self._heard = NEVER

    def news(self) -> Sequence[Mark] | None:
        """Return what lies on the floor, where that is something else than before."""
        now = clock.now()
        if said := self._scenes.newest():
            self._heard = now
        elif not self._text or now - self._heard < LASTS:
            return None
        text = said.data if said else ""
        if text == self._text:
            return None
        self._text = text
        return self._marks(text) if text else []

    def _marks(self, text: str) -> Sequence[Mark]:
        from zteleop.screen.floor import marks  # which a robot in a real room does not need
        from zteleop.sim.plan import from_text

        try:
            return marks(from_text(text))
        except ConfigError as error:
            self._log.warn(str(error), "scene")
            return []
