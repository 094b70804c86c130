"""Says messages on one topic; on a command topic with the proof that they are new."""

from collections.abc import Callable
from typing import Generic, TypeVar

from zteleop.bus import clock, codec
from zteleop.bus.answer import Answer
from zteleop.bus.heard import Hears
from zteleop.bus.session import Outlet
from zteleop.control.command import moves, neutral, steers_only
from zteleop.control.proof import NEVER, Prover
from zteleop.errors import BusError, MessageError
from zteleop.messages import Message

M = TypeVar("M", bound=Message)


class Publisher(Generic[M]):
    """Publishes messages under one key.

    On a command topic each `publish` is an act of the operator, and each `repeat` only
    holds on to the last one.
    """

    def __init__(
        self,
        outlet: Outlet,
        types: tuple[type[M], ...],
        prover: Prover | None = None,
        heard: Hears | None = None,
        listen: Callable[[], object] = lambda: None,
        answer: Answer | None = None,
    ) -> None:
        self._outlet = outlet
        self._prover = prover
        self._heard = heard
        self._listen = listen
        self._answer = answer
        self._moving_since = NEVER
        self._said: type[Message] = types[0]
        self._encodings: dict[type[Message], str] = {kind: codec.encoding_of(kind) for kind in types}

    @property
    def matched(self) -> bool:
        """Somebody subscribes to this topic; the black box of a robot counts as well."""
        return self._outlet.matched

    @property
    def sender(self) -> str:
        """What the robot calls this publisher in `drive_status.operator`."""
        return f"{self._prover.sender:x}" if self._prover else ""

    @property
    def refused(self) -> str:
        """Why this publisher is not obeyed, in the robot's words; empty while it is, or nobody knows."""
        return self._answer.refused if self._answer else ""

    def publish(self, message: M) -> None:
        """Say a message, as an act; raises MessageError when it is of another type or not finite."""
        encoding, payload = self._encode(message)
        self._said = type(message)
        self.act()
        self._put(message, encoding, payload)

    def act(self) -> None:
        """Note that the operator acted."""
        if self._prover and self._heard:
            self._listen()
            self._prover.act(self._heard.beat)

    def let_go(self) -> None:
        """Say neutral and end the claim: the next `publish` begins anew, and may move the robot.

        A refusal is the robot waiting for a person. Let go because a person did, or because the task is
        done; a program that lets go whenever it is `refused` starts a robot by itself, after a restart
        or after somebody released a stop.
        """
        if self._prover and self._heard:
            self._prover.let_go()
            self._listen()
            if rest := neutral(self._said, self._heard.vehicle):
                self._put(rest, *self._encode(rest))

    def leave(self, tell_brief: bool = False) -> None:
        """Let go of what this publisher moves, if anything: its program ends in order, and is not lost.

        To one that said its command once, and ends, it can be told what becomes of that.
        """
        if self._prover and self._prover.moving:
            if self._answer and tell_brief:
                self._answer.end(clock.now() - self._moving_since)
            self.let_go()

    def repeat(self, message: M) -> None:
        """Say a message without a new act."""
        encoding, payload = self._encode(message)
        self._said = type(message)
        self._put(message, encoding, payload)

    def rest(self, message: M) -> None:
        """Say a neutral message and end the claim, as one does who knows the vehicle already.

        The robot may be heard before it has said what neutral pulses are; whoever let go has, all the same.
        """
        self.repeat(message)
        if self._prover:
            self._prover.let_go()

    def _encode(self, message: Message) -> tuple[str, bytes]:
        encoding = self._encodings.get(type(message))
        if encoding is None:
            expected = " or ".join(kind.__name__ for kind in self._encodings)
            raise MessageError(f"expected {expected}, found {type(message).__name__}")
        return encoding, codec.encode(message)

    def _put(self, message: Message, encoding: str, payload: bytes) -> None:
        try:
            self._outlet.put(payload, encoding, self._proof(message))
        except BusError as error:
            raise BusError(f"cannot say a {type(message).__name__}: is its node closed? ({error})") from error

    def _proof(self, message: Message) -> bytes | None:
        if not self._prover or not self._heard:
            return None
        self._listen()
        moving = moves(message, self._heard.vehicle)
        if moving and not self._prover.moving:
            self._moving_since = clock.now()
        if self._answer:
            steers = steers_only(message, self._heard.vehicle)
            self._answer.heed(moving, steers)
            self._answer.advise(message, moving)
        proof = self._prover.prove(self._heard.beat, moving, clock.now(), self._heard.awake_since)
        return codec.pack_proof(proof) if proof else None
