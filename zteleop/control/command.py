"""What a message on a command topic asks for, and the one that asks for nothing."""

from zteleop.control import curvature
from zteleop.control.stick import neutral_pwm
from zteleop.errors import MessageError
from zteleop.messages import Int16MultiArray, Message, MultiArrayLayout, Pwm, Twist, TwistStamped, Vehicle

IN_VAIN = "a robot on wheels obeys linear.x and angular.z, and both are 0"
"""what is to be said of what `asks_in_vain`"""
STEERS_ONLY = "a car turns only while it drives; give linear.x as well as angular.z"
"""what is to be said of what `steers_only`"""


def to_command(message: Message) -> Twist | Pwm:
    """Return what a message commands; raises MessageError when it commands nothing."""
    if isinstance(message, TwistStamped):
        return message.twist
    if isinstance(message, Int16MultiArray):
        if len(message.data) < 2:
            raise MessageError(f"expected [steering, throttle], found {message.data}")
        return Pwm(message.data[0], message.data[1])
    if isinstance(message, Twist | Pwm):
        return message
    raise MessageError(f"a {type(message).__name__} commands nothing")


def neutral(kind: type[Message], vehicle: Vehicle | None) -> Message | None:
    """Return the neutral command of a type, if there is one; of pulses, 0 is none."""
    if not issubclass(kind, Pwm | Int16MultiArray):
        return kind.zero()
    if vehicle is None or not vehicle.takes_ticks:
        return None
    pwm = neutral_pwm(vehicle)
    ticks = [pwm.steering_ticks, pwm.throttle_ticks]
    return pwm if issubclass(kind, Pwm) else Int16MultiArray(MultiArrayLayout.zero(), ticks)


def asks_in_vain(message: Message) -> bool:
    """Say whether a twist asks only for what no ground robot does: to go sideways or up, to roll or pitch."""
    twist = message.twist if isinstance(message, TwistStamped) else message
    return isinstance(twist, Twist) and twist != Twist.zero() and not twist.moves


def steers_only(message: Message, vehicle: Vehicle | None) -> bool:
    """Say whether a twist asks a car to turn on the spot, which turns its front wheels and nothing else."""
    twist = message.twist if isinstance(message, TwistStamped) else message
    if vehicle is None or not vehicle.steers or not isinstance(twist, Twist):
        return False
    return twist.angular.z != 0 and not curvature.rolls(twist.linear.x)


def moves(message: Message, vehicle: Vehicle | None) -> bool:
    """Say whether a command is anything but neutral."""
    if isinstance(message, TwistStamped):
        message = message.twist
    if isinstance(message, Twist):
        return message.moves
    neutral = {channel.name: channel.neutral_ticks for channel in vehicle.channels} if vehicle else {}
    rest = (neutral.get("steering"), neutral.get("throttle"))
    if isinstance(message, Pwm):
        return (message.steering_ticks, message.throttle_ticks) != rest
    return not isinstance(message, Int16MultiArray) or tuple(message.data[:2]) != rest
