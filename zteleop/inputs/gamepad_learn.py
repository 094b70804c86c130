"""Finds out which control of a pad does what, by asking for each in turn."""

from msgspec import convert

from zteleop.inputs.evdev.codes import AXES
from zteleop.inputs.gamepad_map import FORGET, PRESSED, STICKS, USES, GamepadSettings, Moved

FAR, NEAR = 0.7, 0.25
"""of the way from rest: what counts as moved, and as back"""
ASK = {
    "": "move both sticks in a circle, let go of everything, then press and let go of any button",
    "forward": "push the stick that drives all the way forward, and let go",
    "turn": "push the stick that steers all the way to the left, and let go",
    "deadman": "press the button to hold while driving (the dead-man), and let go",
    "turbo": "press the button for full speed; the dead-man again for none",
    "stop": "press the button that stops the robot; the dead-man again for none",
    "release": "press the button that ends the stop; the dead-man again for none",
}
LEFT_OUT = "deadman"


class Lesson:
    """One question after another; a control counts when it is back at rest."""

    def __init__(self) -> None:
        self._begin_anew()

    def _begin_anew(self) -> None:
        self._at: dict[str, float] = {}
        self._rest: dict[str, float] = {}
        self._farthest: dict[str, float] = {}
        self._learned: dict[str, str] = {}
        self._begun = False
        self.complaint = ""
        """Why the last answer does not count."""

    @property
    def question(self) -> str:
        """What to do now; empty when everything is learned."""
        return ASK[self._use] if not self.done else ""

    @property
    def done(self) -> bool:
        """Everything is learned."""
        return self._begun and len(self._learned) == len(USES)

    @property
    def settings(self) -> GamepadSettings:
        """What was learned, once everything is."""
        return convert(self._learned, GamepadSettings)

    def heed(self, moved: Moved) -> None:
        """Take in what moved; another pad begins anew."""
        if moved == FORGET:
            self._begin_anew()
            return
        self._at[moved.name] = moved.value
        self._rest.setdefault(moved.name, moved.value)
        way = moved.value - self._rest[moved.name]
        self._farthest[moved.name] = max(self._farthest.get(moved.name, 0.0), way, key=abs)
        if not self._begun:
            self._begin(moved)
        elif self._is_at_rest() and not self.done:
            self._choose()
            self._farthest.clear()

    @property
    def _use(self) -> str:
        return next((use for use in USES if use not in self._learned), "") if self._begun else ""

    def _begin(self, moved: Moved) -> None:
        """Take where everything is as rest: many a pad tells of a stick only when it was moved once."""
        if moved.name not in AXES and not moved.value and self._farthest[moved.name] > 0:
            self._rest, self._begun = dict(self._at), True
            self._farthest.clear()

    def _is_at_rest(self) -> bool:
        return all(abs(value - self._rest[name]) < NEAR for name, value in self._at.items())

    def _choose(self) -> None:
        """Take what moved farthest; a trigger that is a button as well is the button."""
        self.complaint = ""
        moved = {name: way for name, way in self._farthest.items() if self._counts(name, way)}
        if moved:
            name = max(moved, key=lambda name: (name not in AXES, abs(moved[name])))
            self._learn(f"{'-' if moved[name] < 0 else ''}{name}")
        elif any(abs(way) >= FAR for way in self._farthest.values()):
            self.complaint = "a stick is meant" if self._use in STICKS else "a button is meant"

    def _counts(self, name: str, way: float) -> bool:
        if self._use in STICKS:
            return name in AXES and abs(self._rest[name]) < NEAR and abs(way) >= FAR
        sign = 1 if way > 0 else -1
        return sign * self._rest[name] <= PRESSED < sign * (self._rest[name] + way)

    def _learn(self, control: str) -> None:
        use = self._use
        if use not in (*STICKS, LEFT_OUT) and control == self._learned[LEFT_OUT]:
            control = ""
        for other, its in self._learned.items():
            same_stick = other in STICKS and control.lstrip("-") == its.lstrip("-")
            if control and (same_stick or control == its):
                self.complaint = f"that is {control}, which is {other} already"
                return
        self._learned[use] = control
