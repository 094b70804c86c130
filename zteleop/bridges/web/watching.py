"""What pages hear of the bus: each topic is subscribed to once, and passed on to all who watch it."""

import struct
from collections.abc import Callable, Iterable
from functools import partial

import msgspec
from msgspec import Raw, Struct

from zteleop.bridges.web.slots import Frame, Slots
from zteleop.bridges.web.words import Heard, Note, text
from zteleop.bus import codec
from zteleop.bus.lag import Lag
from zteleop.bus.names import Name, resolve
from zteleop.bus.node import Node
from zteleop.bus.session import Delivery, Ring, Sample
from zteleop.bus.topics import topic_of
from zteleop.errors import ConfigError, MessageError
from zteleop.messages import CompressedImage

DEPTH = 100
"""messages that wait for this process; of a flood the oldest are lost"""
KEPT = {"log": 50}
"""of which topics, and how many, words wait beside each other: a newer one says nothing of those before"""
LARGEST = 2**20
"""bytes of a message that a page is told"""
PICTURE = codec.encoding_of(CompressedImage)
_STAMP = struct.Struct(">d")


class Watched(Struct):
    """A topic, and who hears it."""

    ring: Ring
    delivery: Delivery
    pages: dict[str, Slots]
    passed: int = 0


class Watching:
    """For the node's loop alone."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._topics: dict[str, Watched] = {}

    def watch(self, page: str, slots: Slots, topics: Iterable[str]) -> None:
        """Let a page hear these topics, and no others from now on."""
        wanted = set(topics)
        for topic in [*self._topics]:
            if topic not in wanted:
                self._leave(topic, page)
        for topic in sorted(wanted):
            try:
                self._join(topic, page, slots)
            except ConfigError as error:
                slots.put(f"note {topic}", text(Note(str(error), alarm=True)))

    def forget(self, page: str) -> None:
        """Take in that a page is gone."""
        for topic in [*self._topics]:
            self._leave(topic, page)

    def _join(self, topic: str, page: str, slots: Slots) -> None:
        if topic not in self._topics:
            name = resolve(topic, self._node.robot)
            about = topic_of(name.path)
            key = f"{name.key}/**" if about.command and name.path == about.name else name.key
            session, loop = self._node.membership.session, self._node.membership.loop
            ring = session.overhear(key, DEPTH)
            watched = self._topics[topic] = Watched(ring, _NONE, {})
            inbox = _Inbox(ring, partial(framed, topic, name))
            watched.delivery = session.deliver(inbox, partial(self._pass_on, topic), loop)
        self._topics[topic].pages[page] = slots

    def _leave(self, topic: str, page: str) -> None:
        watched = self._topics[topic]
        watched.pages.pop(page, None)
        if not watched.pages:
            del self._topics[topic]
            watched.ring.undeclare()
            watched.delivery.close()

    def _pass_on(self, topic: str, frame: Frame) -> None:
        if watched := self._topics.get(topic):
            watched.passed += 1
            place = f"{topic} {watched.passed % KEPT[topic]}" if topic in KEPT else topic
            for slots in watched.pages.values():
                slots.put(place, frame)


class _Inbox:
    def __init__(self, ring: Ring, read: Callable[[Sample], Frame | None]) -> None:
        self.ring = ring
        self.read = read
        self.lag = Lag()


class _Nobody:
    def close(self) -> None:
        """Bring no more."""


_NONE = _Nobody()


def framed(topic: str, name: Name, sample: Sample) -> Frame | None:
    """Return what a page is told of a sample; nothing of what is none, or too much."""
    if not sample.is_put or len(sample.payload) > LARGEST:
        return None
    if sample.encoding == PICTURE:
        return pictured(sample)
    format_, _, ros_type = sample.encoding.partition(";")
    if format_ != "application/json" or not is_json(sample.payload):
        return None
    source = sample.key.removeprefix(name.key).strip("/")
    return text(Heard(f"{topic}/{source}" if source else topic, ros_type, Raw(sample.payload)))


def is_json(payload: bytes) -> bool:
    """Say whether bytes may stand within what a page reads."""
    try:
        msgspec.json.decode(payload)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        return False
    return True


def pictured(sample: Sample) -> bytes | None:
    """Return a picture's time of day and its bytes; nothing of what is none."""
    try:
        image = codec.decode(sample.payload, sample.encoding, codec.decoders([CompressedImage]))
    except MessageError:
        return None
    assert isinstance(image, CompressedImage)
    stamp = image.header.stamp
    return _STAMP.pack(stamp.sec + stamp.nanosec * 1e-9) + image.data
