"""The keys of a terminal as a stick: what each key does is a table."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Literal, Self

from msgspec.structs import replace

from zteleop.control.stick import Speeds, Stick
from zteleop.errors import DeviceError
from zteleop.inputs import Wish
from zteleop.inputs.held_keys import FIRST, REPEATING, Block, HeldKeys
from zteleop.inputs.keymap import DIRECTIONS, bindings
from zteleop.inputs.levers import Axis, Levers, Steps
from zteleop.messages import Vehicle
from zteleop.terminal.keys import KeyParser

if TYPE_CHECKING:
    from zteleop.terminal.terminal import Terminal

IDLE_LIMIT = 5.0
"""s without a key until neutral; the robot may shorten it."""
FASTER, SLOWER = 1.1, 0.9
SLOWEST, FASTEST = 0.01, 100.0
"""m/s or rad/s between which keys move a speed, so that it is never stuck at zero."""


class Keyboard:
    """An operator's keys, in steps (latched levers) or held.

    Raises DeviceError without a terminal, ConfigError for a key bound to no action.
    """

    def __init__(
        self,
        drive: Literal["step", "hold"] = "step",
        *,
        speeds: Speeds | None = None,
        steps: Steps | None = None,
        keys: Mapping[str, str] | None = None,
        terminal: "Terminal | None" = None,
    ) -> None:
        self.drive: Literal["step", "hold"] = drive
        self.speeds = speeds or Speeds()
        self.finished = self.rested = False
        self.wish: Wish | None = None
        self.suspending = False
        """Ctrl-Z was pressed: publish neutral, then call `suspend`."""
        self.idle_limit = IDLE_LIMIT
        self._bindings = bindings(keys or {}, {*ACTIONS, *DIRECTIONS})
        self.terminal = terminal or open_terminal()
        self._parser = KeyParser()
        self._levers = Levers(steps)
        self._held = HeldKeys()
        self._block = Block()
        self._fastest = Speeds(FASTEST, FASTEST)
        self._now = 0.0
        self._acted = float("-inf")
        self._resumed = 0
        self._asked = dict.fromkeys(Wish, float("-inf"))

    def __enter__(self) -> Self:
        self.terminal.__enter__()
        return self

    def __exit__(self, *exc: object) -> None:
        self.neutral()
        self.terminal.__exit__(*exc)

    def fileno(self) -> int:
        """Return what turns readable when a key was pressed."""
        return self.terminal.fileno()

    def fit(self, vehicle: Vehicle) -> None:
        """Learn the limits of the robot driven; another calibration is neutral again.

        Raises ConfigError in steps for a vehicle without steering and throttle.
        """
        if self.drive == "step" and self._levers.fit(vehicle):
            self.reset(self._now)
        self.idle_limit = min(IDLE_LIMIT, vehicle.operator_silence)
        self._fastest = Speeds(vehicle.max_speed, vehicle.max_turn)
        self._set_speeds(self.speeds.forward, self.speeds.turn)

    def read(self, now: float) -> bool:
        """Take in the keys pressed, without blocking; True when there were any."""
        self._now = now
        keys = self._parser.flush(now)
        try:
            keys += self._parser.feed(self.terminal.read(), now)
        except EOFError:
            self.quit()
        if self.terminal.resumed != self._resumed:
            self._resumed = self.terminal.resumed
            self.reset(now)
        if self._idle(now):  # a loop that came late must not step on from where it was
            self.neutral()
        for key in keys:
            self._acted = now
            self._press(key)
            self.rested = self.rested or not self.stick(now).deadman
        return bool(keys)

    def stick(self, now: float) -> Stick:
        """Return where the stick is; neutral after `idle_limit` without a key."""
        if self._idle(now):
            self.neutral()
        return self._levers.stick() if self.drive == "step" else self._held.stick(now)

    def idle_left(self, now: float) -> float | None:
        """Return the seconds until neutral for want of a key; None when it is neutral already."""
        return max(0.0, self.idle_limit - (now - self._acted)) if self.stick(now).deadman else None

    def reset(self, now: float) -> None:
        """Go back to neutral; keys held now must be let go first."""
        self.neutral()
        self._block.block(now)

    def suspend(self, now: float) -> None:
        """Stop the process as Ctrl-Z asked and return when it goes on, neutral."""
        self.terminal.suspend()
        self._resumed = self.terminal.resumed
        self._parser = KeyParser()
        self.suspending = False
        self.reset(now)

    def _idle(self, now: float) -> bool:
        return now - self._acted >= self.idle_limit

    def _press(self, key: str) -> None:
        action = self._bindings.get(key) or self._bindings.get(key.lower(), "")
        if (self.finished or self.suspending) and action != "stop robot":
            return
        if action in DIRECTIONS:
            self._drive(key, *DIRECTIONS[action])
        elif action:
            ACTIONS[action](self)

    def _drive(self, key: str, axis: Axis, sign: int) -> None:
        if not self._block.passes(key, self._now) or self.wish is Wish.STOP:
            return
        if self.drive == "step":
            self._levers.press(axis, sign)
        else:
            self._held.press(key, "forward" if axis == "throttle" else "turn", sign, self._now)

    def neutral(self) -> None:
        """Bring both axes to neutral."""
        self._levers.neutral()
        self._held.clear()

    def stop(self) -> None:
        """Bring the throttle to neutral, the steering as it is; held keys are let go."""
        self._levers.neutral("throttle")
        self._held.clear()

    def stop_robot(self) -> None:
        """Go neutral and ask for a stop that stays; a key that repeats is one press."""
        self.reset(self._now)
        self._ask(Wish.STOP, REPEATING)

    def release_robot(self) -> None:
        """Ask for the release of the stop; held down, never of one that came later."""
        self._ask(Wish.RELEASE, FIRST)

    def _ask(self, wish: Wish, gap: float) -> None:
        if self._now - self._asked[wish] > gap and self.wish is not Wish.STOP:
            self.wish = wish
        self._asked[wish] = self._now

    def quit(self) -> None:
        """Ask the program to end, neutral."""
        self.neutral()
        self.finished = True

    def ask_to_suspend(self) -> None:
        """Go neutral and ask the program to call `suspend`."""
        self.reset(self._now)
        self.suspending = True

    def redraw(self) -> None:
        """Write the screen anew."""
        self.terminal.redraw()

    def faster(self) -> None:
        """Raise the forward speed."""
        self._set_speeds(self.speeds.forward * FASTER, self.speeds.turn)

    def slower(self) -> None:
        """Lower the forward speed."""
        self._set_speeds(self.speeds.forward * SLOWER, self.speeds.turn)

    def turn_faster(self) -> None:
        """Raise the turning speed."""
        self._set_speeds(self.speeds.forward, self.speeds.turn * FASTER)

    def turn_slower(self) -> None:
        """Lower the turning speed."""
        self._set_speeds(self.speeds.forward, self.speeds.turn * SLOWER)

    def _set_speeds(self, forward: float, turn: float) -> None:
        self.speeds = replace(
            self.speeds,
            forward=min(max(forward, SLOWEST), self._fastest.forward),
            turn=min(max(turn, SLOWEST), self._fastest.turn),
        )


ACTIONS: dict[str, Callable[[Keyboard], None]] = {
    "stop": Keyboard.stop,
    "neutral": Keyboard.neutral,
    "stop robot": Keyboard.stop_robot,
    "release robot": Keyboard.release_robot,
    "faster": Keyboard.faster,
    "slower": Keyboard.slower,
    "turn faster": Keyboard.turn_faster,
    "turn slower": Keyboard.turn_slower,
    "quit": Keyboard.quit,
    "suspend": Keyboard.ask_to_suspend,
    "redraw": Keyboard.redraw,
}


def open_terminal() -> "Terminal":
    """Return the terminal the program runs in; DeviceError where there is none."""
    try:
        from zteleop.terminal.terminal import Terminal
    except ImportError as error:
        raise DeviceError(
            f"expected a terminal with Unix modes, found a Python without {error.name}; "
            "run it on Linux, macOS or in WSL"
        ) from None
    return Terminal()
