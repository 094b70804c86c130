"""What a simulated robot drives in, as its simulator says it: for the picture."""

from collections.abc import Sequence

from zteleop.bus.node import Node
from zteleop.errors import ConfigError
from zteleop.messages import String
from zteleop.screen.top_view import Mark


class Floor:
    def __init__(self, node: Node) -> None:
        self._log = node.log
        self._scenes = node.subscription("scene", String)
        self._text = ""

    def news(self) -> Sequence[Mark] | None:
        """Return what lies on the floor, where that was not known yet."""
        said = self._scenes.newest()
        if said is None or said.data == self._text:
            return None
        self._text = said.data
        from zteleop.screen.floor import marks  # which a robot in a real room does not need
        from zteleop.sim.scene import parse

        try:
            return marks(parse(said.data.encode()))
        except ConfigError as error:
            self._log.warn(f"a scene that cannot be shown: {error}")
            return None
