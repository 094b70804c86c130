"""What of a command a vehicle does not do as it is asked, in a sentence each; nothing of what it does."""

from math import isfinite

from zteleop.control import curvature
from zteleop.control.command import STEERS_ONLY, steers_only
from zteleop.control.stick import tightest
from zteleop.messages import Int16MultiArray, Message, Pwm, Twist, TwistStamped, Vector3, Vehicle

ROUNDING = 0.01
"""as a part, by which what is asked for may be more"""
OBEYED = "a robot on wheels obeys linear.x and angular.z"


def beyond_ends(message: Message, vehicle: Vehicle | None) -> str:
    """Say which ticks lie beyond a servo's ends, and what is obeyed in their place."""
    pwm = _pwm(message)
    if pwm is None or vehicle is None:
        return ""
    asked = {"steering": pwm.steering_ticks, "throttle": pwm.throttle_ticks}
    found = []
    for channel in vehicle.channels:
        low, high = sorted((channel.min_ticks, channel.max_ticks))
        ticks = asked.get(channel.name, low)
        if not low - 1 <= ticks <= high + 1:  # as far as rounding goes
            end = high if ticks > high else low
            found.append(f"{channel.name} {ticks} ticks is obeyed as {end}, its end")
    return "; ".join([*found, f"a tick is {vehicle.tick_us:.3g} us"]) if found else ""


def spins(message: Message, vehicle: Vehicle | None) -> str:
    """Say that a car does not turn on the spot."""
    return STEERS_ONLY if steers_only(message, vehicle) else ""


def too_fast(message: Message, vehicle: Vehicle | None) -> str:
    """Say which speed is more than the vehicle does, or may do now."""
    twist = _twist(message)
    if twist is None or vehicle is None or not _more(abs(twist.linear.x), vehicle.allowed_speed):
        return ""
    most = f"it does {vehicle.allowed_speed:.3g} at most"
    limited = ": limits.speed is set to that" if _more(vehicle.max_speed, vehicle.allowed_speed) else ""
    return f"{abs(twist.linear.x):.4g} m/s, and {most}{limited}"


def too_tight(message: Message, vehicle: Vehicle | None) -> str:
    """Say which turn is tighter than a car drives, or faster than another vehicle turns.

    Of a car that stands, others say it.
    """
    twist = _twist(message)
    if twist is None or vehicle is None:
        return ""
    turn = abs(twist.angular.z)
    if not vehicle.steers:
        most = vehicle.max_turn
        return f"{turn:.4g} rad/s, and it turns {most:.3g} at most" if _more(turn, most) else ""
    bend, most = abs(curvature.of(twist.linear.x, twist.angular.z)), tightest(vehicle)
    if not curvature.rolls(twist.linear.x) or not _more(bend, most):
        return ""
    return f"a circle of {1 / bend:.2f} m in radius, and {1 / most:.2f} m is the tightest it drives"


def too_slow(message: Message, vehicle: Vehicle | None) -> str:
    """Say which throttle of a car does not turn its motor yet, and which does."""
    throttle = next((one for one in vehicle.channels if one.name == "throttle"), None) if vehicle else None
    if vehicle is None or throttle is None or not throttle.dead_ticks:
        return ""
    dead = throttle.dead_ticks
    if pwm := _pwm(message):
        ends = f"{throttle.neutral_ticks - dead} to {throttle.neutral_ticks + dead}"
        ticks = pwm.throttle_ticks
        return f"throttle {ticks} is in its motor's dead zone, {ends}" if throttle.is_dead(ticks) else ""
    twist = _twist(message)
    if twist is None or not vehicle.steers or not isfinite(twist.linear.x):
        return ""
    end = throttle.max_ticks if twist.linear.x > 0 else throttle.min_ticks
    a_tick = vehicle.max_speed / (abs(end - throttle.neutral_ticks) or 1)
    if not curvature.rolls(twist.linear.x) or round(abs(twist.linear.x) / a_tick) > dead:
        return ""
    least = (dead + 1) * a_tick
    return f"{abs(twist.linear.x):.3g} m/s is in its motor's dead zone; {least:.2g} m/s and more turns it"


def aside(message: Message, vehicle: Vehicle | None = None) -> str:
    """Say what a twist asks for besides what wheels do."""
    twist = _twist(message)
    if twist is None:
        return ""
    asked = {"linear": twist.linear, "angular": twist.angular}
    named = [words for name, vector in asked.items() for words in _aside(name, vector)]
    return f"{' and '.join(named)}; {OBEYED}" if named else ""


def _aside(name: str, vector: Vector3) -> list[str]:
    obeyed = "x" if name == "linear" else "z"
    axes = {"x": vector.x, "y": vector.y, "z": vector.z}
    return [f"{name}.{axis} {value:.3g}" for axis, value in axes.items() if axis != obeyed and value]


def _twist(message: Message) -> Twist | None:
    twist = message.twist if isinstance(message, TwistStamped) else message
    return twist if isinstance(twist, Twist) else None


def _pwm(message: Message) -> Pwm | None:
    if isinstance(message, Int16MultiArray):
        return Pwm(*message.data[:2]) if len(message.data) > 1 else None
    return message if isinstance(message, Pwm) else None


def _more(asked: float, most: float) -> bool:
    return isfinite(asked) and 0 < most * (1 + ROUNDING) < asked
