"""What a recording holds, in the words in which MCAP tells it."""

from typing import NamedTuple

from zteleop.interfaces.channel_form import Form


class Channel(NamedTuple):
    """A topic in one form, in one file."""

    topic: str
    form: Form
    metadata: dict[str, str] = {}
    messages: int = 0
    """how many there are; 0 in the channel of a single message"""

    @property
    def key(self) -> tuple[str, Form, tuple[tuple[str, str], ...]]:
        """All that makes it another channel than another."""
        return self.topic, self.form, tuple(sorted(self.metadata.items()))


class Kept(NamedTuple):
    """A message as it is kept."""

    channel: Channel
    at: int
    """when it arrived, in ns since 1970"""
    published: int
    """when it was said, in ns since 1970"""
    sequence: int
    data: bytes


class Attachment(NamedTuple):
    name: str
    media_type: str
    at: int
    """ns since 1970"""
    data: bytes
    created: int = 0
    """ns since 1970; 0 where nobody has said it"""


class Contents(NamedTuple):
    """What a file holds."""

    profile: str
    library: str
    channels: dict[int, Channel]
    chunks: int
    compression: tuple[str, ...]
    begins: int
    """ns since 1970; 0 where there is no message"""
    ends: int
    indexed: bool
    """It has a summary; one that was cut off has none."""

    @property
    def messages(self) -> int:
        return sum(channel.messages for channel in self.channels.values())
