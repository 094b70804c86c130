"""A device that drives, and a terminal beside it whose keys stop, release and quit, but never drive."""

from collections.abc import Callable
from selectors import EVENT_READ, DefaultSelector
from typing import Self

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs import Drive, Wish
from zteleop.inputs.gamepad import Gamepad
from zteleop.inputs.keyboard import Keyboard
from zteleop.messages import Vehicle
from zteleop.terminal.any_terminal import AnyTerminal


class Console:
    """A pad and a keyboard as one input, and everything that a screen shows of them."""

    def __init__(self, pad: Gamepad, keyboard: Keyboard) -> None:
        self.pad = pad
        self.keyboard = keyboard
        self.drive: Drive = pad.drive
        self._both = DefaultSelector()

    def __enter__(self) -> Self:
        self.pad.__enter__()
        try:
            self.keyboard.__enter__()
        except BaseException:
            self.pad.__exit__()
            raise
        for file in (self.pad.fileno(), self.keyboard.fileno()):
            if file is not None:
                self._both.register(file, EVENT_READ)
        return self

    def __exit__(self, *exc: object) -> None:
        self._both.close()
        self.keyboard.__exit__(*exc)
        self.pad.__exit__(*exc)

    @property
    def terminal(self) -> AnyTerminal:
        """Where the screen is."""
        return self.keyboard.terminal

    @property
    def finished(self) -> bool:
        """The operator asked to end."""
        return self.keyboard.finished

    @property
    def suspending(self) -> bool:
        """Ctrl-Z was pressed: publish neutral, then call `suspend`."""
        return self.keyboard.suspending

    @property
    def rested(self) -> bool:
        """The pad was at neutral since this was last taken."""
        return self.pad.rested

    @rested.setter
    def rested(self, rested: bool) -> None:
        self.pad.rested = rested

    @property
    def wish(self) -> Wish | None:
        """What is asked of the robot, by a button or by a key; a stop goes first."""
        wishes = (self.pad.wish, self.keyboard.wish)
        return Wish.STOP if Wish.STOP in wishes else wishes[0] or wishes[1]

    @wish.setter
    def wish(self, wish: Wish | None) -> None:
        self.pad.wish = self.keyboard.wish = wish

    @property
    def speeds(self) -> Speeds:
        """What a full stick means."""
        return self.pad.speeds

    @speeds.setter
    def speeds(self, speeds: Speeds) -> None:
        self.pad.speeds = speeds

    @property
    def about(self) -> list[tuple[str, str]]:
        """What the operator must do to drive, or why he cannot."""
        return [("pad", self.pad.words)]

    @property
    def in_vain(self) -> str:
        """What there is to say of a key beside the pad that does nothing."""
        return self.keyboard.in_vain

    @property
    def switches(self) -> dict[str, bool]:
        """Which switches there are, and which are on."""
        return self.keyboard.switches

    @property
    def help(self) -> list[tuple[str, str]]:
        """What each button and each key does, while the operator wants to see them."""
        keys = self.keyboard.help
        return [*self.pad.help, *keys] if keys else []

    def fileno(self) -> int:
        """Return what turns readable when something was done."""
        return self._both.fileno()

    def fit(self, vehicle: Vehicle) -> None:
        """Learn the limits of the robot driven."""
        self.pad.fit(vehicle)

    def read(self, now: float) -> bool:
        """Take in what arrived, without blocking; True when the pad is held, and no key is an act."""
        self.keyboard.read(now)
        acts = self.pad.read(now)
        if self.keyboard.finished or self.keyboard.suspending:
            self.pad.reset(now)
            return False
        return acts

    def stick(self, now: float) -> Stick:
        """Return where the pad's stick is now."""
        return self.pad.stick(now)

    def idle_left(self, now: float) -> float | None:
        """Return the seconds until neutral for want of a sign of life; None when nobody holds the pad."""
        return self.pad.idle_left(now)

    def reset(self, now: float) -> None:
        """Go back to neutral; what is held must be let go first."""
        self.pad.reset(now)
        self.keyboard.reset(now)

    def settle(self, clock: Callable[[], float]) -> None:
        """Wait, not for long, until the terminal has said what it can."""
        self.keyboard.settle(clock)
        self.pad.reset(clock())

    def suspend(self, now: float) -> None:
        """Stop the process as Ctrl-Z asked and return when it goes on, neutral."""
        self.keyboard.suspend(now)  # `read` has let the pad go, and does so until here
