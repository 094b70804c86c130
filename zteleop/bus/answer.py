"""What a robot answers to one publisher of commands: they count, they do not, or it is not heard at all."""

from collections.abc import Callable

from zteleop.bus import clock
from zteleop.bus.heard import Heard
from zteleop.bus.log import NodeLog
from zteleop.control.command import IN_VAIN, asks_in_vain
from zteleop.control.gate import Refusal
from zteleop.control.proof import NEVER
from zteleop.control.settings import SOURCES
from zteleop.control.unmet import aside, beyond_ends, spins, too_fast, too_slow, too_tight
from zteleop.messages import Message, Refusals, Vehicle

UNHEARD = 1.0
"""s without a beat while somebody commands"""
LASTS = 2.0
"""s that a refusal holds which the robot does not repeat; a slow stream asks seldom"""
OBEYED_FOR = SOURCES["program"].silence
"""s after a command in which a robot still obeys a program"""
MORE = "more than the robot does"
BRIEF = 0.1
"""s in which no wheel has moved to speak of"""
FALLEN_SILENT, LOOK_EVERY = 1.2, 0.2
"""s until a program is told that it says nothing, and between two looks"""
PAUSE, TOO_SLOW = 5.0, 2
"""s that are no stream any more, and how many gaps in a row make a slow one"""
ANEW = "start this anew, or let_go() in a program, when whoever watches the robot wants it to move"
AFTER = f"when that one is done, {ANEW}"
LET_GO = "let go of everything, and begin anew when it is free"
ADVICE: dict[str, str] = {
    Refusal.EARLIER_START: ANEW,
    Refusal.NOT_FROM_NEUTRAL: ANEW,
    Refusal.LAPSED: ANEW,
    Refusal.BEFORE_RELEASE: ANEW,
    Refusal.BEFORE_REPAIR: ANEW,
    Refusal.AT_REST: ANEW,
    Refusal.HELD: AFTER,
    Refusal.WAITED: ANEW,
    Refusal.STALE: "look at the link, and keep every handler shorter than 0.3 s",
    Refusal.REPLAYED: "publish from one place",
    Refusal.OPERATOR_IDLE: "act again",
}
"""What to do, in place of what the robot advises, which is for everybody."""

UNMET: dict[Callable[[Message, Vehicle | None], str], str] = {
    spins: "turns front wheels and moves nothing",
    too_fast: f"is {MORE}",
    too_tight: f"is {MORE}",
    too_slow: "moves nothing",
    aside: f"is {MORE}",
}
"""what a program is told, once, of a command that is not obeyed as it stands"""


class Answer:
    """Follows what the robot says to one sender, and says to its log what changed."""

    def __init__(
        self,
        sender: str,
        topic: str,
        robot: str,
        heard: Heard,
        log: NodeLog,
        hint: str = "",
        is_program: bool = True,
    ) -> None:
        self._sender = sender
        self._topic = topic
        self._robot = robot
        self._heard = heard
        self._log = log
        self._hint = hint
        self._since = clock.now()
        self._unheard = False
        self._told: Refusals | None = heard.refusals
        self._words = ""
        self._at = NEVER
        self._moved = NEVER
        self._slow = 0
        """How often in a row it was moved on too late."""
        self._untold = dict(UNMET) if is_program else None
        """What a program was not told yet; None for an input, whose operator sees what is obeyed."""

    @property
    def refused(self) -> str:
        """Why what is said does not count, in the robot's words; nothing while it does, or nobody knows."""
        if self._unheard:
            return f"robot {self._robot} is not heard"
        return self._words if clock.now() - self._at <= LASTS else ""

    @property
    def moves(self) -> bool:
        """Whether what was said last is to move the robot, and is not refused."""
        return self._moved > NEVER and not self.refused

    def miss(self) -> None:
        """Say that the robot has not been heard."""
        self._since, self._unheard, self._words = NEVER, True, ""
        more, hint = (" any more", "") if self._heard.beat else ("", self._hint)
        self._log.warn(
            f"robot {self._robot} is not heard{more}; what is said on {self._topic} moves nothing "
            f"until its actuator is on (zteleop node list shows who is there){hint}"
        )

    def end(self, seconds: float) -> None:
        """Say to a program that ends, and so lets go, that what it said lasted too briefly to be seen."""
        if self._untold is not None and seconds < BRIEF and not self.refused:
            self._log.warn(
                f"what was said on {self._topic} held for {seconds * 1000:.0f} ms: a program that ends lets "
                f"go; publish 10 times a second for as long as robot {self._robot} is to move"
            )

    def advise(self, message: Message, moving: bool) -> None:
        """Say of a command that no robot on wheels does it; to a program, once, that this one does less."""
        if not moving:
            if asks_in_vain(message):
                self._log.warn(f"what is said on {self._topic} moves nothing: {IN_VAIN}")
        elif words := beyond_ends(message, self._heard.vehicle):
            self._log.warn(f"what is said on {self._topic} is {MORE}: {words}")
        elif self._untold:
            found = {unmet: unmet(message, self._heard.vehicle) for unmet in self._untold}
            for unmet, words in found.items():
                if words:
                    self._log.warn(f"what is said on {self._topic} {self._untold.pop(unmet)}: {words}")

    def heed(self, moving: bool, steers: bool = False) -> None:
        """Take in what the robot has answered; only who wants to move something misses it.

        What only `steers` is as good said once as ten times a second.
        """
        self._heard.listen_for_refusals()
        self._notice_pace(moving and not steers)
        self._notice_robot(moving)
        self._notice_refusal(moving)

    def look(self) -> float:
        """Tell a program that is silent while its robot is to move; return when to look again.

        For a thread beside it, because what keeps it silent may keep its loop as well.
        """
        now = clock.now()
        silent = now - self._moved
        if self._moved > NEVER and silent > FALLEN_SILENT and self._slow < TOO_SLOW and not self.refused:
            self._slow = TOO_SLOW  # the next one is no news
            self._log.warn(
                f"nothing was said on {self._topic} for {silent:.1f} s, so robot {self._robot} rests; "
                "publish 10 times a second for as long as it is to move, and keep every handler shorter "
                "than 0.3 s"
            )
        return now + LOOK_EVERY

    def _notice_pace(self, moving: bool) -> None:
        """Tell whoever moves the robot again and again, but too seldom, that it rests in between."""
        now = clock.now()
        gap, self._moved = now - max(self._moved, self._heard.awake_since), now if moving else NEVER
        self._slow = self._slow + 1 if OBEYED_FOR < gap < PAUSE else 0
        if self._slow == TOO_SLOW:
            self._log.warn(
                f"{self._topic} is said every {gap:.1f} s, which is too seldom: robot {self._robot} "
                "rests in between; publish 10 times a second or more"
            )

    def _notice_robot(self, moving: bool) -> None:
        # Since it was last listened for: in a long handler nobody does.
        unheard = self._heard.listened - max(self._heard.at, self._since, self._heard.awake_since) > UNHEARD
        if unheard and moving and not self._unheard:
            self.miss()
        elif self._unheard and not unheard:
            self._unheard = False
            self._log.info(f"robot {self._robot} is heard")

    def _notice_refusal(self, moving: bool) -> None:
        now, told = clock.now(), self._heard.refusals
        if told and told is not self._told:
            self._told = told
            words, sentence = self._find(told)
            self._at = now if words else self._at
            self._tell(words, sentence)
        elif moving and self._words and now - max(self._at, self._heard.awake_since) > LASTS:
            self._tell("", "")

    def _find(self, told: Refusals) -> tuple[str, str]:
        """Return the robot's words, and the sentence to tell: what it is, and one advice."""
        ours = next((refused for refused in told.refused if refused.sender == self._sender), None)
        if ours is None:
            return "", ""
        why, rest = ours.why, f" ({told.rest})" if told.rest else ""
        advice = ADVICE.get(why, "")
        if ours.by:
            why = why.replace("another sender", ours.by)
        if not advice:
            return why + rest, why + rest
        if advice in (ANEW, AFTER) and self._untold is None:
            advice = LET_GO
        return why + rest, f"{why.partition('; ')[0]}{rest}; {advice}"

    def _tell(self, words: str, sentence: str) -> None:
        before, self._words = self._words, words
        if words and words != before:
            woke = clock.now() - self._heard.awake_since <= LASTS
            why = ", as this process stood still (suspended, or in a long handler)" if woke else ""
            self._log.warn(f"{self._topic} is refused by robot {self._robot}{why}: {sentence}")
        elif before and not words:
            self._log.info(f"what is said on {self._topic} is no longer refused by robot {self._robot}")
