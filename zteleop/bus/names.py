"""Names of robots and topics, and the keys they stand for.

`/archangel/odom`, `archangel/odom` and, with a robot selected, `odom` and `/odom` are `robot/archangel/odom`.
Nothing else reaches a key expression: a name with a wildcard in it would address every robot.
"""

import re
from typing import NamedTuple

from zteleop.bus.topics import ALIASES, TOPICS
from zteleop.errors import ConfigError

_ROBOT = re.compile(r"[a-z0-9][a-z0-9_-]{0,62}")
_ALIKE = 0.75
"""of a name, from which on it is a mistake for another"""
_CHUNK = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,62}")


class Name(NamedTuple):
    """A robot and a topic path under it."""

    robot: str
    path: str

    @property
    def key(self) -> str:
        return f"robot/{self.robot}/{self.path}"

    def __str__(self) -> str:
        return f"{self.robot}/{self.path}"


def is_robot(text: str) -> bool:
    """Say whether a text can be a robot's name."""
    return _ROBOT.fullmatch(text) is not None


def robot_name(text: str) -> str:
    """Return a robot's name as it is; raises ConfigError when it is none."""
    if not is_robot(text):
        raise ConfigError(
            f"a robot's name is 1 to 63 of a-z, 0-9, _ and -, starting with a letter or digit; found {text!r}"
        )
    return text


def chunk(text: str, what: str) -> str:
    """Return one part of a name as it is; raises ConfigError when it cannot be one."""
    if not _CHUNK.fullmatch(text):
        raise ConfigError(f"{what} is made of a-z, A-Z, 0-9, _ and -; found {text!r}")
    return text


def resolve(text: str, robot: str | None) -> Name:
    """Return what a topic's name stands for; raises ConfigError when it says no robot or is no name."""
    if not isinstance(text, str):  # who comes from rclpy names the type first
        raise ConfigError(f"expected a topic's name, such as 'cmd_vel', and then its type; found {text!r}")
    parts = text.removeprefix("/").removeprefix("robot/").rstrip("/").split("/")
    of_ros = text.startswith("/") and len(parts) == 1 and parts[0] not in ("", robot)  # /odom, as ROS says it
    absolute = text.startswith(("/", "robot/")) and not of_ros
    if not absolute and (len(parts) == 1 or _begins_topic(parts)):
        if robot is None:
            raise ConfigError(
                f"topic {text!r} names no robot; say ROBOT/{'/'.join(parts)}, --robot ROBOT "
                "or Node(..., robot='ROBOT')"
            )
        parts = [robot, *parts]
    elif not absolute and robot not in (None, parts[0]) and not _begins_topic(parts[1:]):
        raise ConfigError(
            f"{text!r} could be robot {parts[0]}'s or {robot}'s; say /{text} or /{robot}/{text}"
        )
    if len(parts) < 2:
        raise ConfigError(
            f"a topic is ROBOT/TOPIC, such as {parts[0] or 'archangel'}/cmd_vel; found {text!r}"
        )
    path = [ALIASES.get(parts[1], parts[1]), *parts[2:]]
    return Name(robot_name(parts[0]), "/".join(chunk(part, "a topic's name") for part in path))


def _begins_topic(parts: list[str]) -> bool:
    """Say whether these parts are, or begin with, a topic that every robot may have."""
    return _known(parts[0]) or "/".join(parts) in TOPICS


def as_typed(text: str, robot: str) -> str:
    """Return a topic of a robot by the name that somebody gave it, an alias perhaps."""
    return text.strip("/").removeprefix("robot/").removeprefix(f"{robot}/")


def known_as(path: str) -> str:
    """Return the known topic that somebody must have meant; nothing for a name of one's own."""
    from difflib import get_close_matches

    return next(iter(get_close_matches(path, [*TOPICS, *ALIASES], 1, _ALIKE)), "")


def _known(part: str) -> bool:
    return part in TOPICS or part in ALIASES
