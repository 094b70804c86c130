"""Where the controls of a pad are now, by what they are used for."""

from zteleop.inputs.gamepad_map import STICKS, GamepadSettings, Moved, rescale


class Controls:
    """Those that the settings give a use, on whichever pad there is."""

    def __init__(self, settings: GamepadSettings) -> None:
        self._deadzone = settings.deadzone
        self._controls = settings.controls
        self._at: dict[str, float] = {}

    def forget(self) -> None:
        """Know nothing of the pad that was there."""
        self._at.clear()

    def move(self, moved: Moved) -> set[str]:
        """Take in where a control is; return the uses it was pressed for. Where one was found is no press."""
        before = {use for use in self._controls if self.presses(use)}
        known = moved.name in self._at
        self._at[moved.name] = moved.value
        return {use for use in self._controls if known and self.presses(use)} - before

    def presses(self, use: str) -> bool:
        """Say whether the control of that use is held down."""
        return use in self._controls and self._controls[use].pressed(self._at)

    def axis(self, use: str) -> float:
        """Return where the stick of that use is beyond its dead zone, -1 to 1."""
        return rescale(self._controls[use].of(self._at), self._deadzone)

    def has(self, use: str) -> bool:
        """Say whether the pad has a control for that use."""
        return use in self._controls and self._controls[use].name in self._at

    def label(self, use: str) -> str:
        """Return what is printed on the control of that use."""
        return self._controls[use].label

    @property
    def missing(self) -> str:
        """What one cannot drive without, and the pad does not have."""
        needed = (self._controls[use].name for use in (*STICKS, "deadman"))
        return " and no ".join(dict.fromkeys(name for name in needed if name not in self._at))
