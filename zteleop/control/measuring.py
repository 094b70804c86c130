"""What somebody who watches the wheels finds out, one step after another, and the servos it makes."""

from collections.abc import Mapping, Sequence
from typing import Literal, NamedTuple

from msgspec.structs import replace

from zteleop.control.servo import Reverse, Servo

Axis = Literal["steering", "throttle"]
Find = Literal[
    "forward starts", "reverse starts", "straight", "full left", "full right", "full forward", "full reverse"
]
APART = 5
"""ticks between neutral and an end, at least: closer, somebody pressed Enter too early"""
WIDEST = (700.0, 2300.0)
"""us between which a servo is turned while its ends are not known"""


class Step(NamedTuple):
    """One question; it is answered by the pulse at which it is so."""

    find: Find
    axis: Axis
    asks: str
    drives: bool = False
    """the wheels are on the floor: the other servo is turned as well, and both no farther than is known"""


STEPS = (
    Step("forward starts", "throttle", "the wheels only just begin to turn forward"),
    Step("reverse starts", "throttle", "the wheels only just begin to turn backward"),
    Step("straight", "steering", "the wheels point straight ahead"),
    Step("full left", "steering", "the wheels have just reached their left end, and the servo does not hum"),
    Step(
        "full right", "steering", "the wheels have just reached their right end, and the servo does not hum"
    ),
    Step("full forward", "throttle", "the wheels turn forward as fast as they ever should"),
    Step("full reverse", "throttle", "the wheels turn backward as fast as they ever should"),
)
TRIM = (Step("straight", "steering", "the car drives straight on", drives=True),)
MOTOR_FIRST = 2
"""steps after which neutral is known: until then the wheels may turn at what is taken for it"""


class Measuring:
    """Goes through steps; `servos` are what is known before, `tick_us` is the chip's."""

    def __init__(self, servos: Mapping[str, Servo], tick_us: float, steps: Sequence[Step] = STEPS) -> None:
        self.steps = steps
        self._before = servos
        self._tick_us = tick_us
        self._number = 0
        self._first = 0
        self._end = min(MOTOR_FIRST, len(steps))
        self.found: dict[Find, float] = {}
        """us, by what was asked for"""
        self._ways = [0.0]
        """us from neutral, how far the motor's pulse went each time that it left it in this step"""
        self._reverse: Reverse | None = None

    @property
    def number(self) -> int:
        """How many steps are behind."""
        return self._number

    @property
    def step(self) -> Step:
        """What is asked for."""
        return self.steps[min(self._number, len(self.steps) - 1)]

    @property
    def is_over(self) -> bool:
        """Every step of this part was answered or left as it was."""
        return self._number >= self._end

    @property
    def is_done(self) -> bool:
        """Nothing more is to be asked for."""
        return self._number == len(self.steps)

    def go_on(self) -> None:
        """Begin the second part, with neutral known; what was found before cannot be changed any more."""
        self._first, self._end = MOTOR_FIRST, len(self.steps)

    def see(self, throttle_us: float) -> None:
        """Take in what leaves the chip for the motor: an ESC that brakes first has to be told twice."""
        off = throttle_us - self.neutral_us
        if abs(off) >= self._tick_us:
            self._ways[-1] = max(self._ways[-1], off, key=abs)
        elif self._ways[-1]:
            self._ways.append(0.0)

    def take(self, pulse_us: float) -> str:
        """Answer a step, unless that cannot be, which is told."""
        if self.is_over:
            return ""
        if wrong := self._wrong(pulse_us):
            return wrong
        if self.step.find == "reverse starts":
            self._reverse = "double_tap" if self._was_there(pulse_us) else "direct"
        self.found[self.step.find] = pulse_us
        self._go_to(self._number + 1)
        return ""

    def skip(self) -> None:
        """Leave what a step asks for as it was before."""
        if not self.is_over:
            self.found.pop(self.step.find, None)
            self._go_to(self._number + 1)

    def back(self) -> str:
        """Ask the step before once more; where that cannot be, say why."""
        if self._number == self._first:
            return "the neutral that was found is in use, and stays" if self._first else "this is the first"
        self._go_to(self._number - 1)
        return ""

    def servos(self) -> dict[str, Servo]:
        """Return both servos as found; raises ValueError where old and new values make none."""
        steering, throttle = self._before["steering"], self._before["throttle"]
        return {
            "throttle": replace(
                throttle,
                min_us=self.found.get("full reverse", throttle.min_us),
                neutral_us=self.neutral_us,
                max_us=self.found.get("full forward", throttle.max_us),
                dead_zone_us=self._dead_zone_us,
                reverse=self._reverse or throttle.reverse,
            ),
            "steering": replace(
                steering,
                min_us=self.found.get("full right", steering.min_us),
                neutral_us=self._straight_us,
                max_us=self.found.get("full left", steering.max_us),
            ),
        }

    def wide(self) -> dict[str, Servo]:
        """Return both servos as they may be turned now: as far as any, about the neutral that is known.

        On the floor no farther than before.
        """
        if self.step.drives:
            return dict(self._before)
        neutral = {"throttle": self.neutral_us, "steering": self._straight_us}
        wide = {}
        for name, servo in self._before.items():
            ends = WIDEST if servo.min_us < servo.max_us else WIDEST[::-1]
            wide[name] = Servo(servo.channel, ends[0], neutral[name], ends[1])
        return wide

    @property
    def neutral_us(self) -> float:
        """Where the motor rests: midway between where it starts to either side."""
        if "forward starts" in self.found and "reverse starts" in self.found:
            return (self.found["forward starts"] + self.found["reverse starts"]) / 2
        return self._before["throttle"].neutral_us

    @property
    def _dead_zone_us(self) -> float:
        """To either side of neutral, the last at which the motor still rests."""
        if "forward starts" in self.found and "reverse starts" in self.found:
            apart = abs(self.found["forward starts"] - self.found["reverse starts"])
            return max(0.0, apart / 2 - self._tick_us)
        return self._before["throttle"].dead_zone_us

    @property
    def _straight_us(self) -> float:
        return self.found.get("straight", self._before["steering"].neutral_us)

    def _go_to(self, number: int) -> None:
        self._number, self._ways = number, [0.0]

    def _was_there(self, pulse_us: float) -> bool:
        """Say whether the pulse was as far to that side before, and has been neutral since."""
        off = pulse_us - self.neutral_us
        return any(way * off > 0 and abs(way) > abs(off) - self._tick_us for way in self._ways[:-1])

    def _wrong(self, pulse_us: float) -> str:
        """Return why a pulse is no answer to the step, and what to do; nothing where it may be one."""
        near = APART * self._tick_us
        match self.step.find:
            case "reverse starts":
                forward = self.found.get("forward starts")
                if forward is not None and abs(pulse_us - forward) < self._tick_us:
                    return "that is where they began to turn forward; go to the other side of neutral"
            case "full left":
                if abs(pulse_us - self._straight_us) < near:
                    return "that is straight ahead; go on until the wheels do not turn any further"
            case "full right":
                left = self.found.get("full left", self._before["steering"].max_us) - self._straight_us
                if (pulse_us - self._straight_us) * left > 0 or abs(pulse_us - self._straight_us) < near:
                    return "that is on the left, or straight ahead; go to the other side of it"
            case "full forward":
                if abs(pulse_us - self.neutral_us) < self._dead_zone_us + near:
                    return "that is hardly faster than where they began to turn; go on"
                if "forward starts" in self.found and not self._same_side("forward starts", pulse_us):
                    return "that is the side on which they turn backward; go to the other one"
            case "full reverse":
                if abs(pulse_us - self.neutral_us) < self._dead_zone_us + near:
                    return "that is hardly faster than where they began to turn; go on"
                forward = self.found.get("full forward", self._before["throttle"].max_us) - self.neutral_us
                if (pulse_us - self.neutral_us) * forward > 0:
                    return "that is the side on which they turn forward; go to the other one"
        return ""

    def _same_side(self, find: Find, pulse_us: float) -> bool:
        return (self.found[find] - self.neutral_us) * (pulse_us - self.neutral_us) > 0
