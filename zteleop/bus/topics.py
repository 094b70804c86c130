"""Every topic of a robot. One topic, one line in the table."""

from typing import NamedTuple

from zteleop.messages import (
    Beat,
    CompressedImage,
    DriveStatus,
    Int16MultiArray,
    InterfaceButtons,
    Latency,
    Log,
    Message,
    Odometry,
    Pwm,
    Range,
    Refusals,
    Stop,
    String,
    Twist,
    TwistStamped,
    Vehicle,
    WatchdogStatus,
    Why,
)


class Topic(NamedTuple):
    """A name, what may be said under it, and how it travels."""

    name: str
    types: tuple[type[Message], ...]
    aliases: tuple[str, ...] = ()
    command: bool = False
    """one leaf per source, and every message carries its proof"""
    urgent: bool = False
    """overtakes whatever waits"""
    depth: int = 10
    """how many are kept for a slow reader; the newest win"""
    every: float = 0.0
    """s at which it is said while there is something to say; 0 where nobody knows"""


_NEWEST = 256
"""of which a reader wants the last, 20 times a second: 5,000 a second that are none pass it by"""
_SAID, _TOLD = 0.05, 0.2
"""s, for whom a robot obeys, and for people"""

TOPICS = {
    topic.name: topic
    for topic in (
        Topic("cmd_vel", (TwistStamped, Twist), ("cmd_vel_stamped",), True, True, depth=100, every=_SAID),
        Topic("pwm", (Pwm, Int16MultiArray), ("controls",), True, True, depth=100, every=_SAID),
        Topic("stop", (Stop,), urgent=True, depth=100, every=_SAID),
        Topic("beat", (Beat,), urgent=True, depth=_NEWEST, every=_SAID),
        Topic("drive_status", (DriveStatus,), urgent=True, every=_SAID),
        Topic("vehicle", (Vehicle,), depth=_NEWEST, every=_TOLD),
        Topic("why", (Why,), depth=_NEWEST, every=_TOLD),
        Topic("refusals", (Refusals,), depth=_NEWEST, every=_TOLD),
        Topic("watchdog", (WatchdogStatus,), depth=_NEWEST, every=_TOLD),
        Topic("latency", (Latency,), every=1.0),
        Topic("odom", (Odometry,), every=_SAID),
        Topic("range", (Range,), every=0.1),
        Topic("scene", (String,), every=1.0),
        Topic("camera/image/compressed", (CompressedImage,), depth=1, every=_SAID),
        Topic("interface_buttons", (InterfaceButtons,)),
        Topic("log", (Log,), depth=100),
    )
}

ALIASES = {alias: topic.name for topic in TOPICS.values() for alias in topic.aliases}


def topic_of(path: str) -> Topic:
    """Return the table's topic that a path such as `cmd_vel/keyboard` belongs to, else a plain one."""
    if path in TOPICS:
        return TOPICS[path]
    head = TOPICS.get(path.partition("/")[0])
    return head if head and head.command else Topic(path, ())
