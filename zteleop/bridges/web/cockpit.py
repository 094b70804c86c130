"""Behind the server: an operator as any other, whose device is whichever page holds the wheel."""

from collections.abc import Callable
from functools import partial

from zteleop.bridges.web.company import Company
from zteleop.bridges.web.echo import Echo
from zteleop.bridges.web.robots import Fleet
from zteleop.bridges.web.slots import Frame, Slots
from zteleop.bridges.web.tuning import Tuning
from zteleop.bridges.web.watching import Watching
from zteleop.bridges.web.wheel import Wheel
from zteleop.bridges.web.words import Held, Hello, Look, Note, Said, Seen, Setting, Watch, Wish, text
from zteleop.bridges.web.words import Wheel as WheelTold
from zteleop.bus import clock
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.inputs import Wish as Asked
from zteleop.messages import Vehicle
from zteleop.nodes.teleop import Teleop
from zteleop.screen.view import View

SOURCE = "web"


class Cockpit:
    """Runs in the node's loop; a server calls `join`, `leave` and `hear` in a thread of its own."""

    def __init__(self, node: Node, vehicle: Vehicle, version: str, lane: Call | None = None) -> None:
        self._node = node
        self._version = version
        self._wheel = Wheel()
        node.membership.echo = lambda heard: Echo(heard, lambda: self._wheel.echo)
        self._teleop = Teleop(node, self._wheel, SOURCE, vehicle, self._show, lane)
        self._watching = Watching(node)
        self._company = Company(node)
        self._tuning = Tuning(node)
        self._fleet = Fleet(node)
        self._pages: dict[str, Slots] = {}
        self._told: tuple[Frame, Frame] = ("", "")
        """of the wheel, and of what is seen, the newest"""

    def run(self) -> None:
        """Drive until the node is stopped; raises BusError when nobody has acknowledged a stop."""
        self._teleop.run()

    def join(self, page: str, slots: Slots) -> None:
        """Let a page in."""
        self._soon(partial(self._join, page, slots))

    def leave(self, page: str) -> None:
        """Forget a page; nobody holds what it held."""
        self._soon(partial(self._leave, page))

    def hear(self, page: str, said: Said) -> None:
        """Take in what a page says."""
        self._soon(partial(self._hear, page, said))

    def _soon(self, act: Callable[[], object]) -> None:
        self._node.membership.loop.call_soon(act)

    def _join(self, page: str, slots: Slots) -> None:
        self._pages[page] = slots
        self._wheel.join(page)
        slots.put("hello", text(Hello(self._node.robot or "", self._version, page)))
        self._tell_wheel()
        if self._told[1]:
            slots.put("seen", self._told[1])

    def _leave(self, page: str) -> None:
        self._pages.pop(page, None)
        self._watching.forget(page)
        self._company.forget(page)
        self._tuning.forget(page)
        self._fleet.forget(page)
        self._wheel.leave(page, clock.now())
        self._teleop.obey()
        self._tell_wheel()

    def _hear(self, page: str, said: Said) -> None:
        slots = self._pages.get(page)
        if slots is None:
            return
        if isinstance(said, Held):
            before = self._wheel.holder
            if said.deadman and not self._wheel.is_held(clock.now()):
                self._teleop.obey()  # what is news of the robot comes before a press, and takes none back
            if self._wheel.hear(page, said, clock.now()):
                self._teleop.obey()
            if self._wheel.holder != before:
                self._tell_wheel()
        elif isinstance(said, Watch):
            self._watching.watch(page, slots, said.topics)
        elif isinstance(said, Look):
            self._company.look(page, slots, said.graph)
            self._tuning.look(page, slots, said.parameters)
            self._fleet.look(page, slots, said.robots)
        elif isinstance(said, Setting):
            self._tuning.set(slots, said)
        elif isinstance(said, Wish):
            self._wish(page, slots, said)

    def _wish(self, page: str, slots: Slots, said: Wish) -> None:
        now, words = clock.now(), ""
        if said.of == "take":
            words = self._wheel.take(page, now)
        elif said.of == "hand over":
            words = self._wheel.hand_over(page, now)
        elif said.of == "stop" or self._wheel.wish is not Asked.STOP:  # which no release takes back
            self._wheel.wish = Asked.STOP if said.of == "stop" else Asked.RELEASE
        self._teleop.obey()
        self._tell_wheel()
        if words:
            slots.put("note", text(Note(words)))

    def _show(self, view: View) -> None:
        """Tell every page what this operator knows, when it is news."""
        seen = text(
            Seen(
                obeyed=view.ours,
                refused=view.refused,
                note=view.note,
                alarm=view.alarm,
                silence=view.silence,
            )
        )
        if seen != self._told[1]:
            self._told = self._told[0], seen
            self._tell("seen", seen)

    def _tell_wheel(self) -> None:
        wheel = text(WheelTold(self._wheel.holder, sorted(self._pages)))
        if wheel != self._told[0]:
            self._told = wheel, self._told[1]
            self._tell("wheel", wheel)

    def _tell(self, kind: str, frame: Frame) -> None:
        for slots in self._pages.values():
            slots.put(kind, frame)
