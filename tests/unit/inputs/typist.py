"""Somebody who types at a terminal that is none."""

from zteleop.control.stick import Stick, to_pwm
from zteleop.inputs import Wish
from zteleop.inputs.keyboard import Keyboard
from zteleop.messages import Vehicle
from zteleop.testing import FakeTerminal

TELLS = b"\x1b[?15u\x1b[?62c"


class Typist:
    def __init__(self, drive: str, vehicle: Vehicle | None, **settings: object) -> None:
        self.terminal = FakeTerminal()
        self.vehicle = vehicle
        self.keyboard = Keyboard(drive, terminal=self.terminal, **settings)
        if vehicle:
            self.keyboard.fit(vehicle)
        self.now = 100.0

    def wish(self) -> Wish | None:
        """Take the wish, as whoever passes it on does."""
        wish, self.keyboard.wish = self.keyboard.wish, None
        return wish

    def type(self, data: bytes, after: float = 0.0) -> bool:
        self.now += after
        self.terminal.typed = data
        return self.keyboard.read(self.now)

    def stick(self, after: float = 0.0) -> Stick:
        self.now += after
        return self.keyboard.stick(self.now)

    def ticks(self) -> tuple[int, int] | None:
        pwm = to_pwm(self.stick(), self.vehicle)
        return pwm and (pwm.steering_ticks, pwm.throttle_ticks)

    def tell_releases(self) -> None:
        """Be a terminal that tells when a key is let go."""
        self.terminal.answers = True
        self.type(b"")
        self.type(TELLS)

    def press(self, *keys: str, after: float = 0.0) -> bool:
        return self.type(b"".join(map(pressed, keys)), after)

    def release(self, *keys: str, after: float = 0.0) -> bool:
        return self.type(b"".join(pressed(key, 3) for key in keys), after)


def pressed(key: str, event: int = 1) -> bytes:
    """Return what a terminal that tells releases sends for a letter."""
    return b"\x1b[%d;1:%du" % (ord(key), event)
