import argparse
import re
from contextlib import closing
from functools import partial
from pathlib import Path

from zteleop.cameras import CAMERAS, Wanted, sources
from zteleop.cli import _options
from zteleop.cli._alone import expect_alone
from zteleop.errors import DeviceError
from zteleop.machine.unsent import unsent
from zteleop.nodes.camera import FASTEST_RATE, TOPIC, Photographer

EXAMPLES = (
    "zteleop camera test",
    "zteleop camera test --size 320x240 --rate 10 --quality 60",
)
LARGEST = 4096
SIMULATED = "a simulated one: zteleop sim --scene track --camera; a test picture: zteleop camera test"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "device",
        nargs="?",
        help=f"{', '.join(CAMERAS)}, /dev/video0, or a film (default: the first that gives a picture)",
    )
    parser.add_argument("--size", metavar="WxH", type=size, default=(640, 480), help="in pixels (640x480)")
    for name, most, default, words in (
        ("--rate", int(FASTEST_RATE), 20, "pictures a second"),
        ("--quality", 100, 80, "where the camera makes no JPEGs itself"),
    ):
        said = f"{words}, 1 to {most} ({default})"
        parser.add_argument(name, metavar="N", type=partial(number, most), default=default, help=said)
    _options.add_parent(parser)


def number(most: int, text: str) -> int:
    """Return a whole number from 1 to the most."""
    if not (text.isdecimal() and len(text) <= 3 and 1 <= int(text) <= most):
        raise argparse.ArgumentTypeError(f"expected 1 to {most}, found {text}")
    return int(text)


def size(text: str) -> tuple[int, int]:
    """Return width and height in pixels."""
    found = re.fullmatch(r"(\d{2,4})x(\d{2,4})", text)
    if not found or max(width := int(found[1]), height := int(found[2])) > LARGEST:
        raise argparse.ArgumentTypeError(f"expected WIDTHxHEIGHT in pixels, such as 640x480, found {text!r}")
    return width, height


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    width, height = arguments.size
    wanted = Wanted(width, height, arguments.rate, arguments.quality)
    if arguments.device and not Path(arguments.device).exists() and arguments.device not in CAMERAS:
        there = ", ".join(map(str, sorted(Path("/dev").glob("video*")))) or "none"
        raise DeviceError(f"there is no {arguments.device}; cameras here: {there}; {SIMULATED}")
    with _options.join("camera", settings, settle=True) as node:
        expect_alone(node, TOPIC, "what the camera of {robot} sees")
        _options.end_with_parent(arguments, node)
        with closing(Photographer(node, partial(sources, arguments.device), wanted, unsent)):
            try:
                node.spin()
            except DeviceError as error:
                raise DeviceError(f"{error}; {SIMULATED}") from None
