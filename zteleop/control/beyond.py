"""What of a command is more than a vehicle does, and what is obeyed in its place."""

from math import isfinite

from zteleop.control import curvature
from zteleop.control.stick import tightest
from zteleop.messages import Message, Pwm, Twist, TwistStamped, Vehicle

ROUNDING = 0.01
"""as a part, by which what is asked for may be more"""


def beyond_ends(message: Message, vehicle: Vehicle | None) -> str:
    """Say which ticks lie beyond a servo's ends, and what is obeyed in their place; nothing of others."""
    if not isinstance(message, Pwm) or vehicle is None:
        return ""
    asked = {"steering": message.steering_ticks, "throttle": message.throttle_ticks}
    for channel in vehicle.channels:
        low, high = sorted((channel.min_ticks, channel.max_ticks))
        ticks = asked.get(channel.name, low)
        if not low - 1 <= ticks <= high + 1:  # as far as rounding goes
            end = high if ticks > high else low
            tick = f"a tick is {vehicle.tick_us:.3g} us"
            return f"{channel.name} {ticks} ticks is obeyed as {end}, its end; {tick}"
    return ""


def too_fast(message: Message, vehicle: Vehicle | None) -> str:
    """Say which speed of a twist is more than the vehicle does, and what is obeyed; nothing of others."""
    twist = message.twist if isinstance(message, TwistStamped) else message
    if not isinstance(twist, Twist) or vehicle is None:
        return ""
    speed, most = abs(twist.linear.x), vehicle.max_speed
    return f"{speed:.4g} m/s is obeyed as {most:.2f}, the most it does" if _more(speed, most) else ""


def too_tight(message: Message, vehicle: Vehicle | None) -> str:
    """Say which turn is tighter than a car drives, or faster than another vehicle turns, and what is obeyed.

    Nothing of others, nor of a car that stands.
    """
    twist = message.twist if isinstance(message, TwistStamped) else message
    if not isinstance(twist, Twist) or vehicle is None:
        return ""
    turn = abs(twist.angular.z)
    if not vehicle.steers:
        most = vehicle.max_turn
        return f"{turn:.4g} rad/s is obeyed as {most:.2f}, the most it turns" if _more(turn, most) else ""
    bend, most = abs(curvature.of(twist.linear.x, twist.angular.z)), tightest(vehicle)
    if not curvature.rolls(twist.linear.x) or not _more(bend, most):
        return ""
    return f"a circle of {1 / bend:.2f} m in radius is obeyed as one of {1 / most:.2f} m, its tightest"


def _more(asked: float, most: float) -> bool:
    return isfinite(asked) and 0 < most * (1 + ROUNDING) < asked
