import argparse
from math import tau

from zteleop.cli import _options
from zteleop.cli._motion import ASTRAY, Motion
from zteleop.control.motion import pace
from zteleop.control.motion.pursuit import Pursuit
from zteleop.control.motion.trail import Trail

EXAMPLES = (
    "zteleop goto 1m 20cm --speed 1m/s",
    "zteleop goto 1.5 0 --within 20cm --speed 1m/s",
)
SOURCE = "planner"
WITHIN, CLOSE = 0.1, 0.04


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    here = "0 0 is where its odometry began, looking along x"
    parser.add_argument("x", metavar="X", type=_options.place, help=f"such as 1m; {here}")
    parser.add_argument("y", metavar="Y", type=_options.place, help="to the left, such as -50cm")
    parser.add_argument(
        "--speed", type=_options.measure("speed"), help="such as 0.2m/s at most (default: an easy one)"
    )
    parser.add_argument(
        "--within",
        metavar="LENGTH",
        type=_options.measure("length"),
        default=WITHIN,
        help=f"how near is near enough (default: {100 * WITHIN:g}cm)",
    )


def run(arguments: argparse.Namespace) -> None:
    with _options.join("goto", _options.load(arguments)) as node:
        motion = Motion("goto", node, SOURCE)
        vehicle, pose = motion.vehicle, motion.look()
        x, y = arguments.x, arguments.y
        speed = arguments.speed or pace.straight_speed(vehicle)
        if (off := pose.distance(x, y)) <= arguments.within:
            nearer = f"; nearer is --within {50 * off:.0f}cm" if off > CLOSE else ""
            print(f"{node.robot} is there already, {off:.2f} m off{nearer}")
            return
        here, there = f"x {pose.x:.2f} m, y {pose.y:.2f} m", f"x {x:.2f} m, y {y:.2f} m"
        print(f"drives from {here} to {there}, at {speed:g} m/s at most; Ctrl-C stops it", flush=True)
        course = Pursuit(vehicle, x, y, speed, arguments.within)
        most = ASTRAY * off + 2 * tau * pace.easy_radius(vehicle) + 1  # and it may have to turn round first
        motion.drive(course, lambda trail: told(trail, x, y), most=most)


def told(trail: Trail, x: float, y: float) -> str:
    """Return how near it came."""
    end = trail.end
    off = f"{end.distance(x, y):.2f} m from there"
    return f"ended at x {end.x:.2f} m, y {end.y:.2f} m, {off}; went {trail.way:.2f} m, {trail.seconds:.1f} s"
