"""What a message on a command topic asks for."""

from zteleop.errors import MessageError
from zteleop.messages import Int16MultiArray, Message, Pwm, Twist, TwistStamped


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
