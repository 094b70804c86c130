import argparse
from math import ceil, tau

from zteleop.cli import _options
from zteleop.cli._motion import ASTRAY, Motion, add_figure, announce
from zteleop.control.motion import pace
from zteleop.control.motion.course import Laps
from zteleop.control.motion.trail import Trail
from zteleop.errors import ConfigError
from zteleop.messages import Twist, Vehicle

EXAMPLES = (
    "zteleop circle 1m --laps 0.2",
    "zteleop circle 1m --right --speed 0.8m/s --laps 0.2",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "radius", type=_options.measure("length"), help="such as 50cm: the circle is twice as wide"
    )
    parser.add_argument("--laps", metavar="N", type=laps, default=1.0, help="how often (default: once)")
    add_figure(parser)


def run(arguments: argparse.Namespace) -> None:
    with _options.join("circle", _options.load(arguments)) as node:
        motion = Motion("circle", node)
        vehicle, radius = motion.vehicle, arguments.radius
        check(vehicle, radius, f"{node.robot}")
        motion.look()
        speed = arguments.speed or pace.circle_speed(vehicle, radius)
        twist = Twist.planar(speed, (-speed if arguments.right else speed) / radius)
        announce(node, twist, arguments.laps * tau * radius / speed)
        most = ASTRAY * arguments.laps * tau * radius + 1
        motion.drive(Laps(twist, arguments.laps), lambda trail: told(trail, radius), most=most)


def check(vehicle: Vehicle, radius: float, robot: str) -> None:
    """Raise ConfigError for a circle that is too tight for a vehicle."""
    if radius < (least := pace.least_radius(vehicle)):
        fits = f"{ceil(100 * least)}cm"
        raise ConfigError(
            f"expected a radius of {fits} or more, as {robot} steers no tighter, found {100 * radius:g}cm; "
            f"zteleop circle {fits} is the tightest it drives"
        )


def told(trail: Trail, wanted: float) -> str:
    """Return how wide a circle was, beside how wide it was meant."""
    radius = trail.radius()
    measured = f"a radius of {radius:.2f} m" if radius else "no circle"
    return (
        f"{measured}, as odometry saw it; {wanted:.2f} m were meant; {trail.way:.2f} m, {trail.seconds:.1f} s"
    )


def laps(text: str) -> float:
    """Return how often to go round, as typed."""
    try:
        found = float(text)
    except ValueError:
        found = 0.0
    if not 0 < found <= 1000:
        raise argparse.ArgumentTypeError(f"expected a number of laps such as 2 or 0.5, found {text}")
    return found
