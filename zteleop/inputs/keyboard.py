"""The keys of a terminal as a stick: what each key does is a table."""

import select
from collections.abc import Callable, Mapping
from typing import Self

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs import Drive, Wish
from zteleop.inputs.held_keys import FIRST, HELD_BEFORE, REPEATING, Block
from zteleop.inputs.holding import Holding
from zteleop.inputs.keymap import DIRECTIONS, OTHER, TOGGLE, Moves, bindings, describe, first_keys, switches
from zteleop.inputs.levers import Levers, Steps
from zteleop.inputs.speed_keys import FASTER, SLOWER, SpeedKeys
from zteleop.inputs.wishes import Wishes
from zteleop.messages import Vehicle
from zteleop.terminal.any_terminal import AnyTerminal
from zteleop.terminal.keys import Key
from zteleop.terminal.typed import Keys, Typed, open_terminal

IDLE_LIMIT = 5.0
"""s without a key until neutral; the robot may shorten it."""
ANSWERED_WITHIN = 0.3
"""s that a terminal has to say what it can; one that is far may say so later."""


class Keyboard:
    """An operator's keys, in steps (latched levers) or held.

    A key that is held is known by its release where the terminal tells it, else by its repeats.

    Raises DeviceError without a terminal, ConfigError for a key bound to no action or a keymap there is not.
    """

    def __init__(
        self,
        drive: Drive = "step",
        *,
        speeds: Speeds | None = None,
        steps: Steps | None = None,
        keymap: str = "all",
        keys: Mapping[str, str] | None = None,
        terminal: AnyTerminal | None = None,
        typed: Keys | None = None,
    ) -> None:
        self.drive: Drive = drive
        self.finished = False
        self.rested = False
        self.suspending = False
        """Ctrl-Z was pressed: publish neutral, then call `suspend`."""
        self.idle_limit = IDLE_LIMIT
        self._bindings = bindings(keys or {}, keymap)
        self._typed: Keys = typed or Typed(terminal or open_terminal())
        self.speed_keys = SpeedKeys(speeds or Speeds())
        self._wishes = Wishes(switches(self._bindings))
        self._levers = Levers(steps)
        self._holding = Holding()
        self._block = Block()
        self._now = 0.0
        self._acted = float("-inf")

    def __enter__(self) -> Self:
        self.terminal.__enter__()
        return self

    def __exit__(self, *exc: object) -> None:
        self.neutral()
        self._typed.close()
        self.terminal.__exit__(*exc)

    @property
    def terminal(self) -> AnyTerminal:
        """Where the keys come from."""
        return self._typed.terminal

    @property
    def speeds(self) -> Speeds:
        """What a full stick means, in m/s and rad/s."""
        return self.speed_keys.speeds

    @speeds.setter
    def speeds(self, speeds: Speeds) -> None:
        self.speed_keys.speeds = speeds

    @property
    def wish(self) -> Wish | None:
        """What the operator asks of the robot besides; whoever takes it leaves None."""
        return self._wishes.newest

    @wish.setter
    def wish(self, wish: Wish | None) -> None:
        self._wishes.newest = wish

    @property
    def bound(self) -> dict[str, str]:
        """For each action the key to name where there is room for one."""
        return first_keys(self._bindings)

    @property
    def help(self) -> list[tuple[str, str]]:
        """The keys of each action and what they do, while the operator wants to see them."""
        return describe(self._bindings, self.drive) if self._wishes.help else []

    @property
    def tells_releases(self) -> bool:
        """Whether the terminal tells when a key is let go."""
        return self._typed.releases.told

    @property
    def certainty(self) -> str:
        """How sure it is which keys are held, and what would make it surer."""
        if self.tells_releases:
            how = self._typed.releases.how
            return f"release told ({how})" if self._typed.releases.focused else "no focus: neutral"
        return "release guessed; kitty, foot, ghostty tell it"

    @property
    def in_vain(self) -> str:
        """Why what was just pressed counts for nothing, and what to do."""
        return HELD_BEFORE if self._block.is_felt(self._now) else self._wishes.missed(self._now)

    @property
    def switches(self) -> dict[str, bool]:
        """Which switches there are, and which are on."""
        return self._wishes.switches

    @property
    def about(self) -> list[tuple[str, str]]:
        """What a screen says of it: how sure it is which keys are held, and what is switched on."""
        told = ", ".join(f"{name} {'on' if on else 'off'}" for name, on in self.switches.items())
        return [("keys", self.certainty), *([("switches", told)] if told else [])]

    def settle(self, clock: Callable[[], float]) -> None:
        """Wait, not for long, until the terminal has said what it can.

        What is typed meanwhile moves and releases nothing; whoever stops or quits does.
        """
        give_up = clock() + ANSWERED_WITHIN
        self.read(clock())
        while not self._typed.releases.known and (left := give_up - clock()) > 0:
            select.select([self.terminal], [], [], left)
            self.read(clock())
        self.reset(clock())
        if self._wishes.newest is Wish.RELEASE:
            self._wishes.newest = None

    def fileno(self) -> int | None:
        """Return what turns readable when a key was pressed."""
        return self._typed.fileno()

    def fit(self, vehicle: Vehicle) -> None:
        """Learn the limits of the robot driven; another calibration is neutral again.

        Raises ConfigError in steps for a vehicle without steering and throttle.
        """
        if self.drive == "step" and self._levers.fit(vehicle):
            self.reset(self._now)
        self._holding.steers = vehicle.steers
        self.idle_limit = min(IDLE_LIMIT, vehicle.operator_silence)
        self.speed_keys.fit(vehicle)

    def read(self, now: float) -> bool:
        """Take in what happened to the keys, without blocking; True when somebody acts."""
        self._now = now
        keys = self._typed.read(now)
        self._holding.be_told(self.tells_releases)
        if self._typed.ended:
            self.quit()
        if self._typed.went_on(now):
            self.reset(now)
        if self._idle(now):  # a loop that came late must not step on from where it was
            self.neutral()
        for key in keys:
            if key.event == "release":
                self._holding.release(key)
            else:
                self._acted = now
                self._press(key)
            self.rested = self.rested or not self.stick(now).deadman
        self._watch(now)
        acts = self._holding.known or any(key.event != "release" for key in keys)
        self._acted = now if acts else self._acted
        return acts

    def stick(self, now: float) -> Stick:
        """Return where the stick is; neutral after `idle_limit` without a key."""
        if self._idle(now):
            self.neutral()
        return self._levers.stick() if self.drive == "step" else self._holding.stick(now)

    def idle_left(self, now: float) -> float | None:
        """Return the seconds until neutral for want of a key; None when it is neutral already."""
        return max(0.0, self.idle_limit - (now - self._acted)) if self.stick(now).deadman else None

    def reset(self, now: float) -> None:
        """Go back to neutral; keys held now must be let go first."""
        self.neutral()
        self._block.block(now)

    def suspend(self, now: float) -> None:
        """Stop the process as Ctrl-Z asked and return when it goes on, neutral."""
        self._typed.suspend(now)
        self.suspending = False
        self.reset(now)

    def _idle(self, now: float) -> bool:
        return now - self._acted >= self.idle_limit

    def _watch(self, now: float) -> None:
        """Let everything go when a release may be lost: with the focus, or a terminal that is silent."""
        releases = self._typed.releases
        if not releases.focused:
            self.neutral()
            self._holding.look_away(now)
        elif self._holding.known:
            releases.ping(now)
            if releases.is_silent(now):
                self.neutral()

    def _press(self, key: Key) -> None:
        names = (key.name, key.name.lower(), OTHER)
        action = next((self._bindings[name] for name in names if name in self._bindings), "")
        self._wishes.note(key.name, action, self.bound, self._now)
        if (self.finished or self.suspending) and action != "stop robot":
            return
        if action in DIRECTIONS:
            self._drive(key, DIRECTIONS[action])
        elif action.startswith(TOGGLE):
            self._toggle(key, action.removeprefix(TOGGLE))
        elif action:
            ACTIONS[action](self)

    def _drive(self, key: Key, moves: Moves) -> None:
        passes = self._block.passes(key.name, self._now)
        is_known_press = self.tells_releases and key.event == "press"
        if not (passes or is_known_press) or self.wish is Wish.STOP:
            return
        if self.drive == "hold":
            self._holding.press(key, moves, self._now)
            return
        for axis, sign in moves:
            self._levers.press(axis, sign)

    def _toggle(self, key: Key, switch: str) -> None:
        """Switch once for each press; where a repeat may look like one, once for each time it is held."""
        if key.event != "repeat":
            self._wishes.toggle(switch, 0.0 if self.tells_releases else FIRST, self._now)

    def neutral(self) -> None:
        """Bring both axes to neutral."""
        self._levers.neutral()
        self._holding.clear()

    def stop(self) -> None:
        """Bring the throttle to neutral, the steering as it is; held keys are let go."""
        self._levers.neutral("throttle")
        self._holding.clear()

    def stop_robot(self) -> None:
        """Go neutral and ask for a stop that stays; a key that repeats is one press."""
        self.reset(self._now)
        self._wishes.ask(Wish.STOP, REPEATING, self._now)

    def release_robot(self) -> None:
        """Ask for the release of the stop; held down, never of one that came later."""
        self._wishes.ask(Wish.RELEASE, FIRST, self._now)

    def quit(self) -> None:
        """Ask the program to end, neutral."""
        self.neutral()
        self.finished = True

    def ask_to_suspend(self) -> None:
        """Go neutral and ask the program to call `suspend`."""
        self.reset(self._now)
        self.suspending = True

    def toggle_help(self) -> None:
        """Show what each key does, or hide it."""
        self._wishes.help = not self._wishes.help


ACTIONS: dict[str, Callable[[Keyboard], None]] = {
    "stop": Keyboard.stop,
    "neutral": Keyboard.neutral,
    "stop robot": Keyboard.stop_robot,
    "release robot": Keyboard.release_robot,
    "faster": lambda keyboard: keyboard.speed_keys.scale(forward=FASTER),
    "slower": lambda keyboard: keyboard.speed_keys.scale(forward=SLOWER),
    "turn faster": lambda keyboard: keyboard.speed_keys.scale(turn=FASTER),
    "turn slower": lambda keyboard: keyboard.speed_keys.scale(turn=SLOWER),
    "all faster": lambda keyboard: keyboard.speed_keys.scale(forward=FASTER, turn=FASTER),
    "all slower": lambda keyboard: keyboard.speed_keys.scale(forward=SLOWER, turn=SLOWER),
    "nothing": lambda keyboard: None,
    "quit": Keyboard.quit,
    "suspend": Keyboard.ask_to_suspend,
    "redraw": lambda keyboard: keyboard.terminal.redraw(),
    "help": Keyboard.toggle_help,
}
