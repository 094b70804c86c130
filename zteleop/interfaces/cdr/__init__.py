"""Messages as DDS sends them and ROS 2 records them: XCDR1 plain, a header of four bytes first.

A function is made for each type, from what ROS declares of it. (DDS-XTypes 1.3, section 7.4.1)
"""

from zteleop.interfaces.cdr.reading import decoder
from zteleop.interfaces.cdr.writing import encoder
from zteleop.messages import Message

__all__ = ["decode", "decoder", "encode", "encoder"]


def encode(message: Message) -> bytes:
    """Return a message as CDR; raises MessageError for one that has no place there."""
    return encoder(type(message))(message)


def decode(data: bytes, kind: type[Message]) -> Message:
    """Return the message that CDR is; raises MessageError when it is none of its type."""
    return decoder(kind)(data)
