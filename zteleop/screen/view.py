"""What there is to show of one robot and of whoever drives it, at one moment."""

from typing import NamedTuple

from zteleop.control.stick import Stick
from zteleop.messages import DriveStatus, Odometry, Pwm, Twist, Vehicle


class Unmanned(NamedTuple):
    """A robot without an actuator, as its watchdog tells: in a word, and in a sentence."""

    word: str
    why: str


class View(NamedTuple):
    """What was not heard is None."""

    now: float = 0.0
    vehicle: Vehicle | None = None
    stick: Stick = Stick()
    command: Twist | Pwm | None = None
    """What is asked for; None is rest."""
    status: DriveStatus | None = None
    """None when no actuator is heard"""
    ours: bool = False
    """the robot obeys this device"""
    refused: str = ""
    """Why it does not, in the robot's words; empty while it does, or nobody knows"""
    odom: Odometry | None = None
    """None when nobody says where it is"""
    odom_lost: bool = False
    """somebody said where it is, and does so no more"""
    unmanned: Unmanned | None = None
    """its watchdog's word, while it has no actuator"""
    silence: float = 0.0
    """s for which the robot has said nothing, where that is too long: what it said last may be over"""
    note: str = ""
    alarm: bool = False
    """the note says what the operator must know now"""

    @property
    def pwm(self) -> Pwm | None:
        """The ticks asked for; None where they are neutral, or a twist is asked for."""
        return self.command if isinstance(self.command, Pwm) else None

    @property
    def twist(self) -> Twist | None:
        """The twist asked for; None where it is rest, or ticks are asked for."""
        return self.command if isinstance(self.command, Twist) else None
