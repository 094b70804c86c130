"""A node's publishers of commands: each waits for its robot, and hears whether what it says is obeyed."""

from typing import Any, TypeVar

from zteleop.bus import presence
from zteleop.bus.answer import Answer
from zteleop.bus.heard import HEARD_WITHIN
from zteleop.bus.in_the_way import InTheWay
from zteleop.bus.log import NodeLog
from zteleop.bus.membership import Membership
from zteleop.bus.names import Name
from zteleop.bus.publisher import Publisher
from zteleop.bus.topics import topic_of
from zteleop.control.proof import Prover
from zteleop.control.settings import INPUTS
from zteleop.machine.ids import new_id
from zteleop.messages import Log, Message

M = TypeVar("M", bound=Message)


class Commands:
    """Those of one node; `hint` goes where its robot is not heard."""

    def __init__(self, node: str, membership: Membership, log: NodeLog, hint: str) -> None:
        self._node = node
        self._membership = membership
        self._log = log
        self._hint = hint
        self._publishers: list[Publisher[Any]] = []

    def leave(self) -> None:
        """Let go of every robot."""
        for publisher in self._publishers:
            publisher.leave(tell_brief=not self._membership.has_spun)

    def await_robot(self, robot: str) -> bool:
        """Wait, once, until a robot is heard and its start is over; True when it is there."""
        words = f"waits for robot {robot}, {HEARD_WITHIN:g} s at most; is its actuator on?"

        def tell() -> None:
            here = presence.here(self._membership.session, robot)
            self._log.info(f"{words} {here} (zteleop node list shows who is there){self._hint}")

        return self._membership.heard(robot).wait(tell)

    def publisher(
        self, name: Name, kinds: tuple[type[M], ...], source: str, wait: bool, said: str
    ) -> Publisher[M]:
        """Return a sender of commands, called `said`, as a source of some kind."""
        about, membership, robot = topic_of(name.path), self._membership, name.robot
        heard = membership.heard(robot)
        found = self.await_robot(robot) if wait else True
        sender, is_program = new_id(), source not in INPUTS
        answer = Answer(f"{sender:x}", said, robot, heard, self._log, self._hint, is_program)
        if not found:
            answer.miss()
        elif wait and (words := presence.unknown_source(membership.session, name)):
            self._log.warn(words)
        membership.session.declare_token(presence.sender_key(robot, sender, self._node))
        publisher = Publisher[M](
            membership.outlet(name, kinds, about.urgent),
            kinds,
            Prover(sender),
            membership.echo(heard),
            membership.listen_now,
            answer,
        )
        self._publishers.append(publisher)
        if is_program:  # an input's operator sees both on his screen
            logs = membership.inbox(f"/{robot}/log", (Log,), complain=False)
            membership.beside(answer.look)
            membership.beside(InTheWay(logs, robot, answer, self._log.warn).look)
        return publisher
