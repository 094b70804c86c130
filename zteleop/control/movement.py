"""How a claim moves the robot: cap -> limiter -> mixer -> servo."""

from typing import NamedTuple

from zteleop.control.calibration import Calibration
from zteleop.control.cap import Bound, Cap
from zteleop.control.limiter import Limits, TwistLimiter, WheelLimiter
from zteleop.control.mixer import Wheels
from zteleop.control.mux import Claim
from zteleop.control.reversing import Reversing
from zteleop.control.settings import DriveSettings
from zteleop.messages import Twist


class Moved(NamedTuple):
    """What one step makes of a claim."""

    wheels: Wheels | None
    """None where the robot rests"""
    bound: Bound
    """how fast it may go, and what says so"""


class Movement:
    """Bounds what is asked for, and makes wheels of it."""

    def __init__(self, settings: DriveSettings, calibration: Calibration) -> None:
        self.cap = Cap(settings.cap, settings.limits.speed_of(settings.mixer), settings.known_sources)
        self._mixer = settings.mixer
        self._calibration = calibration
        self._limiter = TwistLimiter(settings.limits, settings.mixer)
        self._wheel_limiter = WheelLimiter(settings.limits, settings.mixer, settings.servos)
        self._reversing = Reversing({name: settings.servos[name] for name in settings.mixer.driven})

    @property
    def limits(self) -> Limits:
        """The bounds that hold, never wider than those of the settings."""
        return self._limiter.limits

    @limits.setter
    def limits(self, limits: Limits) -> None:
        self._limiter.limits = self._wheel_limiter.limits = limits
        self.cap.tune(limits.speed_of(self._mixer))

    def obey(self, claim: Claim | None, now: float) -> Moved:
        """Return the wheels of now; without a claim those of rest."""
        bound = self.cap.find(claim.source, now) if claim else self.cap.rest()
        wheels = self._wheel_limiter.limit(self._wheels(claim, bound.speed, now), now)
        self._reversing.note(wheels or self._calibration.rest, now)
        return Moved(wheels, bound)

    def _wheels(self, claim: Claim | None, max_speed: float, now: float) -> Wheels | None:
        if claim is None:
            self._limiter.limit(None, now)
            return None
        if isinstance(claim.command, Twist):
            twist = self._limiter.limit(claim.command, now, max_speed)
            return self._tapped(self._mixer.mix(twist)) if twist else None
        self._limiter.limit(None, now)
        wheels = self._wheel_limiter.cap(self._calibration.wheels(claim.command), max_speed)
        self._limiter.follow(self._mixer.unmix(wheels))
        return wheels

    def _tapped(self, wheels: Wheels) -> Wheels:
        """Return what an ESC is told on its way to reverse; the ramp begins anew where that is neutral."""
        told = self._reversing.ask(wheels)
        if told != wheels:
            self._limiter.follow(self._mixer.unmix(told))
        return told
