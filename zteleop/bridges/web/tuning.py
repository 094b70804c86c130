"""The parameters of a robot's nodes, for pages that look: asked in a thread, as an answer may take long."""

from collections import deque
from collections.abc import Sequence

from zteleop.bridges.web.slots import Frame, Slots
from zteleop.bridges.web.words import Note, Parameters, Setting, Tuned, text
from zteleop.bus import clock, presence
from zteleop.bus.node import Node
from zteleop.bus.node_parameters import NodeParameters
from zteleop.errors import BusError, MessageError
from zteleop.interfaces.parameters import from_python, to_python, type_words
from zteleop.messages import (
    FloatingPointRange,
    IntegerRange,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
)

LOOK_EVERY = 0.1
"""s until something that a page wants is done"""
ASK_EVERY = 2.0
"""s between two looks at what others may have changed"""
OR = " or "
"""between the texts that a parameter may be"""


class Tuning:
    """Called in the node's loop, but for `_look`; a slow node keeps nobody from driving."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._pages: dict[str, Slots] = {}
        self._wanted: deque[tuple[Slots, Setting]] = deque()
        self._told: Frame = ""
        self._asked = float("-inf")
        self._begun = False

    def look(self, page: str, slots: Slots, looks: bool) -> None:
        """Tell a page of the parameters from now on, whenever they change, or no longer."""
        if not looks:
            self.forget(page)
            return
        self._pages = {**self._pages, page: slots}
        if self._told:
            slots.put("parameters", self._told)
        self._begin()

    def forget(self, page: str) -> None:
        """Take in that a page looks no longer, or is gone."""
        self._pages = {name: slots for name, slots in self._pages.items() if name != page}

    def set(self, slots: Slots, wanted: Setting) -> None:
        """Change a parameter soon; a page whose wish is refused is told why."""
        self._wanted.append((slots, wanted))
        self._begin()

    def _begin(self) -> None:
        if not self._begun:
            self._begun = True
            self._node.membership.beside(self._look)

    def _look(self) -> float:
        now = clock.now()
        is_news = bool(self._wanted)
        while self._wanted:
            self._change(*self._wanted.popleft())
        if is_news or (self._pages and now - self._asked >= ASK_EVERY):
            self._asked = now
            self._tell(text(Parameters(self._ask())))
        return clock.now() + LOOK_EVERY

    def _change(self, slots: Slots, wanted: Setting) -> None:
        try:
            node = self._of(wanted.node)
            (described,) = node.describe([wanted.name])
            value = float(wanted.value) if described.type == ParameterValue.DOUBLE else wanted.value
            (result,) = node.set([Parameter(wanted.name, from_python(value))])
            wrong = "" if result.successful else result.reason
        except (BusError, MessageError, ValueError) as error:
            wrong = f"{wanted.name}: {error}"
        if wrong:
            self._told = ""  # what the page shows is what it wished, and not what is
            slots.put("note", text(Note(f"{wanted.node}: {wrong}", alarm=True)))

    def _ask(self) -> list[Tuned]:
        robot, session = self._node.robot, self._node.membership.session
        nodes = sorted({one.node for one in presence.with_parameters(session) if one.robot == robot})
        return [tuned for name in nodes for tuned in tuned_of(name, self._of(name))]

    def _of(self, name: str) -> NodeParameters:
        return NodeParameters(self._node.membership.session, self._node.robot or "", name)

    def _tell(self, word: Frame) -> None:
        if word != self._told:
            self._told = word
            for slots in self._pages.values():
                slots.put("parameters", word)


def tuned_of(name: str, node: NodeParameters) -> Sequence[Tuned]:
    """Return what a node says of its parameters; nothing of one that does not answer."""
    try:
        names = sorted(node.names())
        return [
            _tuned(name, value, about)
            for value, about in zip(node.get(names), node.describe(names), strict=True)
        ]
    except BusError:
        return []


def _tuned(node: str, value: ParameterValue, about: ParameterDescriptor) -> Tuned:
    bounds: list[FloatingPointRange | IntegerRange] = [*about.floating_point_range, *about.integer_range]
    choices = about.additional_constraints.split(OR) if about.type == ParameterValue.STRING else []
    return Tuned(
        node=node,
        name=about.name,
        type=type_words(about.type),
        value=to_python(value),
        says=about.description,
        least=bounds[0].from_value if bounds else None,
        most=bounds[0].to_value if bounds else None,
        choices=choices if len(choices) > 1 else [],
        read_only=about.read_only,
    )
