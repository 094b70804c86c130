"""A keyboard that turns one servo at a time, and takes the answers of whoever watches the wheels."""

from collections.abc import Callable, Sequence

from zteleop.control.measuring import Measuring
from zteleop.control.stick import neutral_pwm, to_pwm
from zteleop.inputs.answering import ANSWERS, FAR, TURNS, Answering
from zteleop.inputs.keyboard import Keyboard
from zteleop.inputs.levers import Steps
from zteleop.messages import Pulse, Vehicle
from zteleop.terminal.typed import Keys

KEYMAP = "donkey"
OWN = {"space": "neutral", "k": "nothing", **dict.fromkeys((*FAR, *ANSWERS), "nothing")}
BACKWARD = ("reverse starts", "full reverse")
TOLD = ("stop robot", "release robot", "neutral", "quit", "help")
"""the actions that the bottom line names"""


class Tuner(Keyboard):
    """The operator of `zteleop calibrate`: one tick a press, of the servo that is asked for."""

    def __init__(self, typed: Keys, measuring: Measuring) -> None:
        self._answering = Answering(typed)
        super().__init__("step", steps=Steps(1, 1), keymap=KEYMAP, keys=OWN, typed=self._answering)
        self._measuring = measuring
        self._out: dict[str, Pulse] = {}
        self._vehicle: Vehicle | None = None
        self._turned = False
        """by this step"""
        self._note = ""
        self._answering.axis, self._answering.drives = measuring.step.axis, measuring.step.drives

    @property
    def gave_up(self) -> bool:
        """Whoever answers has left before the end."""
        return self.finished and not self._measuring.is_over

    @property
    def bound(self) -> dict[str, str]:
        """For each action the key to name where there is room for one."""
        bound = super().bound
        return {action: bound[action] for action in TOLD}

    @property
    def help(self) -> list[tuple[str, str]]:
        """What each key does, while somebody wants to see it."""
        if not super().help:
            return []
        return [
            (", ".join(TURNS[self._measuring.step.axis]), "turn it by one tick, and there it stays"),
            (", ".join(FAR), "by ten"),
            ("enter", "that is it: the next step"),
            ("s", "leave this one as it was before"),
            ("b", "back to the step before"),
            ("k", "keep it there for another 5 s"),
            ("space", "neutral"),
            ("backspace, r", "STOP the robot, and release it"),
            ("q", "neutral, and quit; nothing is written"),
        ]

    @property
    def in_vain(self) -> str:
        """Why what was just typed counts for nothing."""
        return self._note or super().in_vain

    @property
    def about(self) -> list[tuple[str, str]]:
        """What was found so far."""
        found = ", ".join(f"{find} {ticks}" for find, ticks in self.found)
        return [("found", found or "nothing so far")]

    @property
    def found(self) -> list[tuple[str, int]]:
        """The answers so far, in ticks."""
        return [(find, self._ticks(width)) for find, width in self._measuring.found.items()]

    def task(self) -> list[tuple[str, str]]:
        """Return what is asked for."""
        step = self._measuring.step
        one, other = TURNS[step.axis]
        steps = len(self._measuring.steps)
        number = f"{min(self._measuring.number + 1, steps)} of {steps}"
        drives = "up and down drive, " if step.drives else ""
        words = [(number, f"{drives}{one} and {other} turn the {step.axis}. Press enter when {step.asks}.")]
        if step.find in BACKWARD:
            words.append(("", "many an ESC brakes first: then space, and down once more"))
        return [*words, ("", f"{', '.join(FAR)}: ten ticks; k keeps it there; s: as it was; b: back")]

    def see(self, out: Sequence[Pulse]) -> None:
        """Take in what leaves the chip."""
        self._out = {pulse.name: pulse for pulse in out}
        if "throttle" in self._out:
            self._measuring.see(self._out["throttle"].pulse_us)

    def fit(self, vehicle: Vehicle) -> None:
        """Learn the limits of the robot driven."""
        super().fit(vehicle)
        self._vehicle = vehicle

    def settle(self, clock: Callable[[], float]) -> None:
        """Wait, not for long, until the terminal has said what it can; nothing typed then is an answer."""
        super().settle(clock)
        self._answering.answers.clear()

    def read(self, now: float) -> bool:
        """Take in what was typed, without blocking; True when somebody acts."""
        acts = super().read(now)
        answers, self._answering.answers = self._answering.answers, []
        if acts:
            self._note = ""
        for answer in answers:
            self._answer(answer, now)
        self._turned = self._turned or self.stick(now).deadman
        return acts

    def _answer(self, answer: str, now: float) -> None:
        measuring = self._measuring
        if answer == "enter":
            self._note = self._early(now) or measuring.take(self._out[measuring.step.axis].pulse_us)
            if self._note:
                return
        elif answer == "s":
            measuring.skip()
        elif said := measuring.back():
            self._note = said
            return
        self._answering.axis = measuring.step.axis
        self._turned = False
        self.neutral()
        self.finished = self.finished or measuring.is_over

    def _early(self, now: float) -> str:
        """Return why there is nothing to take yet: the chip is not where the keys are."""
        axis = self._measuring.step.axis
        if axis not in self._out or self._vehicle is None:
            return "the robot is not heard: nothing to take"
        pwm, out = to_pwm(self.stick(now), self._vehicle), self._out[axis].duty_ticks
        wanted = pwm or neutral_pwm(self._vehicle)
        asked = wanted.steering_ticks if axis == "steering" else wanted.throttle_ticks
        if abs(asked - out) > 1:
            return f"asked for {asked}, and the chip puts out {out}: see why, then enter"
        return "" if pwm else self._at_rest(out)

    def _at_rest(self, out: int) -> str:
        """Return why neutral is no answer: it may have come by itself, after 5 s without a key."""
        turned, self._turned = self._turned, False
        if self._measuring.step.find != "straight":
            return f"it is at neutral, {out}: turn it, and k keeps it there"
        again = (
            f"it went back to neutral, {out}: turn it again (k keeps it there), or enter once more for {out}"
        )
        return again if turned else ""

    def _ticks(self, pulse_us: float) -> int:
        return round(pulse_us / self._vehicle.tick_us) if self._vehicle else round(pulse_us)
