import argparse
from math import degrees

from zteleop.cli import _options
from zteleop.cli._motion import ASTRAY, Motion, add_figure
from zteleop.control.motion import pace
from zteleop.control.motion.trail import Trail
from zteleop.control.motion.way import Way, square

EXAMPLES = (
    "zteleop square 1m --speed 1m/s",
    "zteleop square 50cm --right --speed 1m/s",
)
CORRECTS = 3.0
"""1/m: how tightly a robot that turns on the spot goes back to its line"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("side", type=_options.measure("length"), help="such as 1m")
    add_figure(parser)


def run(arguments: argparse.Namespace) -> None:
    with _options.join("square", _options.load(arguments)) as node:
        motion = Motion("square", node)
        vehicle, side = motion.vehicle, arguments.side
        start, corner = motion.look(), pace.easy_radius(vehicle)
        speed = arguments.speed or pace.straight_speed(vehicle)
        corners = f"arcs of {corner:.2f} m, for it cannot turn on the spot" if corner else "turns on the spot"
        sides = f"drives four sides of {side:g} m at {speed:g} m/s, joined by {corners}"
        print(f"{sides}; Ctrl-C stops it", flush=True)
        most = 1 / pace.least_radius(vehicle) if vehicle.steers else CORRECTS
        legs = square(start, side, corner, arguments.right)
        way = ASTRAY * sum(leg.length for leg in legs) + 1
        motion.drive(Way(legs, speed, pace.turn_speed(vehicle), most), told, most=way)


def told(trail: Trail) -> str:
    """Return how far from its start the robot ended."""
    off = trail.end.distance(trail.start.x, trail.start.y)
    turned = f"{degrees(trail.turned):+.0f} deg"
    return f"ended {off:.2f} m from where it began, turned {turned}; {trail.way:.2f} m, {trail.seconds:.1f} s"
