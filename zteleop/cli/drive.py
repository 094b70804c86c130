import argparse
from collections.abc import Sequence
from typing import Literal

from zteleop.cli import _options
from zteleop.cli._motion import Motion, announce, went
from zteleop.control.motion.course import Steady
from zteleop.errors import ConfigError
from zteleop.messages import Twist
from zteleop.text.quantity import quantity

EXAMPLES = (
    "zteleop drive 0.5m/s --for 1s",
    "zteleop drive 0.4m/s 30deg/s --for 2s",
)
ASKED: tuple[Literal["speed", "turn"], ...] = ("speed", "turn")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "motion",
        metavar="SPEED",
        nargs="+",
        help="how fast, such as 0.2m/s, 20cm/s, -0.2m/s; and how fast it turns: 30deg/s is to the left",
    )
    parser.add_argument(
        "--for", metavar="TIME", dest="lasts", type=_options.seconds, help="end after 2s (default: by Ctrl-C)"
    )


def run(arguments: argparse.Namespace) -> None:
    twist = to_twist(arguments.motion)
    with _options.join("drive", _options.load(arguments)) as node:
        motion = Motion("drive", node)
        announce(node, twist, arguments.lasts)
        motion.drive(Steady(twist, arguments.lasts), went, by_sight=False)


def to_twist(words: Sequence[str]) -> Twist:
    """Return what is asked for in words: a speed, a turning speed, or both; bare numbers are m/s, then rad/s.

    Raises ConfigError when they are none.
    """
    found: dict[str, float] = {}
    for word in words:
        left = [dimension for dimension in ASKED if dimension not in found]
        if not left:
            raise ConfigError(f"a speed and a turning speed say it all, found {word!r} as well")
        wrong: list[ConfigError] = []
        for dimension in left:
            try:
                found[dimension] = quantity(word, dimension)
                break
            except ConfigError as error:
                wrong.append(error)
        else:
            raise wrong[0]
    return Twist.planar(found.get("speed", 0.0), found.get("turn", 0.0))
