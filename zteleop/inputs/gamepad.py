"""A pad as a stick that counts only while its dead-man button is held."""

from typing import Self

from zteleop.control.stick import Speeds, Stick
from zteleop.errors import ConfigError
from zteleop.inputs import Drive, Wish
from zteleop.inputs.gamepad_controls import Controls
from zteleop.inputs.gamepad_map import FORGET, GamepadSettings, Moved, Pads
from zteleop.inputs.keymap import DOES
from zteleop.messages import Vehicle

RELEASE_HELD = 1.0
"""s that the button is held to end a stop: a thumb that slips ends none"""


class Gamepad:
    """Whichever pad there is.

    After a start, another pad, a stop or a lost link it counts once the sticks rest and the dead-man is up.
    """

    drive: Drive = "hold"

    def __init__(
        self, pads: Pads, settings: GamepadSettings | None = None, speeds: Speeds | None = None
    ) -> None:
        self.settings = settings or GamepadSettings()
        self.finished = False
        self.rested = False
        self.wish: Wish | None = None
        self.silence = self.settings.silence
        self._pads = pads
        self._controls = Controls(self.settings)
        self._speeds = speeds or Speeds()
        self._fastest = self._speeds
        self._ready = False
        self._silent = False
        self._heard = float("-inf")
        self._release_since: float | None = None

    def __enter__(self) -> Self:
        self._pads.__enter__()
        return self

    def __exit__(self, *exc: object) -> None:
        self._controls.forget()
        self._pads.__exit__(*exc)

    @property
    def speeds(self) -> Speeds:
        """What a full stick means: the robot's most while turbo is held."""
        return self._fastest if self._controls.presses("turbo") else self._speeds

    @speeds.setter
    def speeds(self, speeds: Speeds) -> None:
        if self._controls.presses("turbo"):
            raise ConfigError("turbo is held, which is as fast as the robot can; let go of it first")
        self._speeds = speeds

    def fileno(self) -> int | None:
        """Return what turns readable when a control moved; None where nothing does."""
        return self._pads.fileno()

    def fit(self, vehicle: Vehicle) -> None:
        """Learn the limits of the robot driven."""
        self._fastest = Speeds(vehicle.max_speed, vehicle.max_turn)
        self.silence = min(self.settings.silence, vehicle.operator_silence)

    def read(self, now: float) -> bool:
        """Take in what moved, without blocking; True while the dead-man is held on a pad that is alive.

        A pad tells of changes alone, so one out of reach looks like a steady hand: after `silence` without
        a change it counts as let go.
        """
        if self._holding and now - self._heard >= self.silence:
            self.reset(now)
            self._silent = True
        for moved in self._pads.read(now):
            self._heard = now
            self._take(moved, now)
            self.rested = self.rested or not self._holding
        self._look_at_release(now)
        return self._holding

    def stick(self, now: float) -> Stick:
        """Return where the stick is; nobody holds it unless the dead-man, or turbo, is held."""
        if not self._holding or now - self._heard >= self.silence:
            return Stick()
        return Stick(self._controls.axis("forward"), self._controls.axis("turn"), deadman=True)

    def idle_left(self, now: float) -> float | None:
        """Return the seconds until neutral unless the pad gives a sign of life; None when nobody holds it."""
        return max(0.0, self.silence - (now - self._heard)) if self._holding else None

    def reset(self, now: float) -> None:
        """Go back to neutral; the dead-man must be let go and the sticks at rest before they count."""
        self._ready = False
        self._get_ready()

    def stop_robot(self, now: float) -> None:
        """Go neutral and ask for a stop that stays."""
        self.wish = Wish.STOP
        self.reset(now)

    @property
    def words(self) -> str:
        """What the operator must do to drive, or why he cannot, in a sentence."""
        name = self._pads.name
        hold = self._controls.label("deadman")
        if not name:
            return self._pads.trouble or "waiting for a gamepad: plug one in, or switch it on"
        if missing := self._controls.missing:
            return f"{name} has no {missing}; zteleop gamepad --learn finds out what it has"
        if self._ready:
            return f"{name}: {self._help()}"
        if self._silent:
            return f"{name} has not moved for {self.silence:g} s; let go of everything, then hold {hold} anew"
        return f"{name}: let go of {hold} and of the sticks before you drive"

    @property
    def help(self) -> list[tuple[str, str]]:
        """What each button does; those that the pad has."""
        does = {
            "deadman": "to drive, while it is held",
            "turbo": "to drive at full speed, while it is held",
            "stop": DOES["stop robot"],
            "release": f"{DOES['release robot']}, after {RELEASE_HELD:g} s",
        }
        return [(self._controls.label(use), what) for use, what in does.items() if self._controls.has(use)]

    @property
    def _holding(self) -> bool:
        return self._ready and self._is_enabled()

    def _is_enabled(self) -> bool:
        return self._controls.presses("deadman") or self._controls.presses("turbo")

    def _take(self, moved: Moved, now: float) -> None:
        if moved == FORGET:
            self._controls.forget()
            self._release_since = None
            self.reset(now)
            return
        pressed = self._controls.move(moved)
        if "stop" in pressed:
            self.stop_robot(now)
        if "release" in pressed:
            self._release_since = now
        self._get_ready()

    def _get_ready(self) -> None:
        if self._ready or self._is_enabled() or not self._pads.name or self._controls.missing:
            return
        if not self._controls.axis("forward") and not self._controls.axis("turn"):
            self._ready = True
            self._silent = False

    def _look_at_release(self, now: float) -> None:
        """Ask for the end of a stop once the button was held alone for a while."""
        if self._is_enabled() or self._controls.presses("stop") or not self._controls.presses("release"):
            self._release_since = None
        elif self._release_since is not None and now - self._release_since >= RELEASE_HELD:
            self._release_since = None
            self.wish = self.wish or Wish.RELEASE

    def _help(self) -> str:
        does = {"deadman": "to drive", "turbo": "for full speed"}
        pad = self._controls
        held = [f"hold {pad.label(use)} {what}" for use, what in does.items() if pad.has(use)]
        stop = [f"{pad.label('stop')} stops the robot"] if pad.has("stop") else []
        release = [f"{pad.label('release')} held ends the stop"] if pad.has("release") else []
        return ", ".join([*held, *stop, *release])
