"""What one step of a simulated robot costs, one picture of its camera, and a second of a test's robot."""

import timeit
from collections.abc import Callable
from time import perf_counter

from figures import is_quick, median, p99, print_table, verdict

from zteleop.cli import _scenes
from zteleop.control.vehicles import VEHICLES
from zteleop.messages import Twist
from zteleop.nodes.picture import Painter
from zteleop.sim import make_vehicle
from zteleop.sim.body import Body
from zteleop.sim.camera import Camera
from zteleop.sim.create3.body import Create3
from zteleop.sim.world import World
from zteleop.testing import FakeNode, SimulatedRobot

STEP = 0.01
"""s, as in `zteleop sim`"""
STEP_US, PICTURE_MS, TIMES_REAL = 50.0, 4.0, 20.0
PULSE_US = {0: 1560.0, 1: 1600.0}


def body(vehicle: str) -> Body:
    built = VEHICLES[vehicle]
    return Create3(built.servos) if vehicle == "create3" else make_vehicle(built.mixer, built.servos)


def driving(vehicle: str, scene: str) -> Callable[[], object]:
    """Return a step of a vehicle that drives circles in a scene, or on a floor without end."""
    robot = body(vehicle)
    if scene:
        robot.room = World(_scenes.find(scene), robot.discs)
    return lambda: robot.step(dict(PULSE_US), STEP)


def pictures(scene: str) -> Callable[[], object]:
    """Return what takes a picture where the scene starts."""
    found = _scenes.find(scene)
    painter, world = Painter(Camera(found)), World(found, body("car").discs)
    return lambda: painter.jpeg(world)


def us(act: Callable[[], object], batches: int, repeats: int) -> list[float]:
    return [1e6 * seconds / repeats for seconds in timeit.repeat(act, number=repeats, repeat=batches)]


def times_real(seconds: float) -> float:
    """Return how many seconds of a test's robot pass in one."""
    node = FakeNode()
    SimulatedRobot(node, scene=_scenes.find("track"))
    motors = node.publisher("cmd_vel", Twist)
    node.every(0.1)(lambda: motors.publish(Twist.planar(0.5, 0.1)))
    began = perf_counter()
    node.live(seconds)
    return seconds / (perf_counter() - began)


def main() -> None:
    quick = is_quick(__doc__)
    batches, repeats = (10, 20) if quick else (100, 100)
    rows: list[tuple[object, ...]] = []
    for vehicle in VEHICLES:
        for scene in ("", "track"):
            found = us(driving(vehicle, scene), batches, repeats)
            what = f"step of a {vehicle} {f'in the {scene}' if scene else 'on an open floor'}, us"
            rows.append((what, median(found), p99(found), verdict(median(found), STEP_US, "us")))
    for scene in _scenes.names():
        found = [one / 1000 for one in us(pictures(scene), batches, 1)]
        rows.append(
            (
                f"picture of the {scene}, ms",
                median(found),
                p99(found),
                verdict(median(found), PICTURE_MS, "ms"),
            )
        )
    print_table("a simulated robot", ("what", "median", "p99", "target"), rows)
    fast = [times_real(5.0 if quick else 60.0) for _ in range(3)]
    met = "met" if median(fast) >= TIMES_REAL else "MISSED"
    print(f"\na test's robot on the track: {median(fast):.0f} times real time; >= {TIMES_REAL:g}: {met}")


if __name__ == "__main__":
    main()
