"""Who hears a topic as another type than it is said, and drops it: both are to know."""

from collections.abc import Callable, Iterable

from zteleop.bus import clock, presence
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.bus.session import Session
from zteleop.messages import Message

COMINGS = 100
"""of those who hear a topic, which wait to be looked at"""
FIRST_LOOK, LOOK_EVERY = 0.1, 1.0
"""s until whoever was here before is told of, and from then on"""

Type = tuple[str, str]
"""a ROS type, and the hash of its fields where it does not come with zteleop"""


class Hearers:
    """Those of one topic; `tell` hears a sentence of each who hears it as no type that it is said in."""

    def __init__(
        self, session: Session, name: Name, kinds: Iterable[type[Message]], tell: Callable[[str], object]
    ) -> None:
        selector = f"robot/{name.robot}/live/sub/*/*/*/{name.path}"
        self._ring = session.watch_tokens(selector, COMINGS, history=True)
        self._name = name
        self._said = [presence.type_of(kind) for kind in kinds]
        self._tell = tell

    def watch(self, loop: Loop) -> None:
        """Look at who comes, in a loop, for as long as that runs."""
        alarm = loop.alarm(lambda: alarm.ring_at(self._look()))
        alarm.ring_at(clock.now() + FIRST_LOOK)

    def _look(self) -> float:
        """Look at who has come; return when to look again."""
        while (sample := self._ring.try_recv()) is not None:
            if sample.is_put and (ears := presence.endpoints_of(sample.key)):
                self._judge(ears)
        return clock.now() + LOOK_EVERY

    def _judge(self, ears: list[presence.Endpoint]) -> None:
        one = ears[0]
        if one.type != presence.ANY and not any((ear.type, ear.hash) in self._said for ear in ears):
            said, heard_as = told_apart(self._said[0], (one.type, one.hash))
            where = f"{one.node} on {one.process}"
            self._tell(f"{self._name}: {where} hears {heard_as} alone, and drops what is said here, {said}")


def told_apart(said: Type, heard: Type) -> tuple[str, str]:
    """Return two types as words that differ: by their hashes where both have one name."""
    if said[0] != heard[0]:
        return said[0], heard[0]
    return f"{said[0]} {said[1]}".rstrip(), heard[1] or "another"
