"""Reads the simulated chip as a car would, moves in its scene, and says where it is."""

from collections.abc import Callable
from math import degrees
from random import Random

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.settings import DriveSettings
from zteleop.drivers.registers import read_pulse_us
from zteleop.drivers.simulated import open_registers
from zteleop.messages import Header, Odometry, Range, String
from zteleop.nodes.create3 import Equipment
from zteleop.sim import make_vehicle
from zteleop.sim.body import Body
from zteleop.sim.create3.body import Create3
from zteleop.sim.ranges import RangeSensor
from zteleop.sim.scene import Scene
from zteleop.sim.world import World

PERIOD, AT_REST = 0.01, 0.05
"""s between two looks at the chip, and while the vehicle stands"""
STANDS = 0.001
"""m/s, or rad/s"""
TELL_EVERY = 1.0
STANDS_BELOW = 0.001
"""m between two looks"""


def run(
    node: Node,
    settings: DriveSettings,
    path: str,
    show: Callable[[str], None] = print,
    scene: tuple[Scene, str] | None = None,
    kind: str = "",
) -> None:
    """Move a vehicle by the pulses in a register file until the node is stopped, and show how it moves.

    In a scene, which comes with its text, it runs into what stands there, and says how far that is. Of a
    `create3` all that such a robot has is there. Raises ConfigError for a scene in which it does not fit.
    """
    vehicle = Create3(settings.servos) if kind == "create3" else make_vehicle(settings.mixer, settings.servos)
    world = furnish(node, vehicle, *scene) if scene else None
    if isinstance(vehicle, Create3):
        Equipment(node, vehicle, world)
    registers = open_registers(path)
    odoms = node.publisher("odom", Odometry)
    channels = [servo.channel for servo in settings.servos.values()]
    then = clock.now()

    def move() -> None:
        nonlocal then
        now = clock.now()
        snapshot = registers.snapshot()
        vehicle.step({channel: read_pulse_us(snapshot, channel) for channel in channels}, now - then)
        then = now
        stands = abs(vehicle.speed) < STANDS and abs(vehicle.yaw_rate) < STANDS
        looks.pace(AT_REST if stands else PERIOD, now)

    looks = node.membership.loop.every(PERIOD, move)

    @node.every(TOPICS["odom"].every)
    def tell() -> None:
        odoms.publish(vehicle.odometry(clock.stamp()))

    rolled, moved = 0.0, False

    @node.every(TELL_EVERY)
    def show_motion() -> None:
        nonlocal rolled, moved
        moves = vehicle.distance - rolled >= STANDS_BELOW
        if moves or moved:
            show(motion(vehicle))
        rolled, moved = vehicle.distance, moves

    node.spin()


def furnish(node: Node, vehicle: Body, scene: Scene, text: str) -> World:
    """Put a vehicle into a scene; say what that is, what it hits, and how far it is to what stands ahead."""
    world = vehicle.room = World(scene, vehicle.discs)
    sensor, chance = RangeSensor(), Random(0)
    scenes, ranges = node.publisher("scene", String), node.publisher("range", Range)
    told = ""

    node.every(TOPICS["scene"].every)(lambda: scenes.publish(String(text)))

    @node.every(TOPICS["range"].every)
    def look() -> None:
        nonlocal told
        ahead = sensor.measure(world, world.nose)
        ranges.publish(sensor.state(Header(clock.stamp(), "range"), ahead, chance))
        touched = world.contact.name if world.contact else ""
        if touched and touched != told:
            node.log.warn(f"it stands at {scene.called(touched)}, and can only drive away from there")
        told = touched

    return world


def motion(vehicle: Body) -> str:
    """Return in a line how a vehicle moves, and where it is."""
    place = f"x {vehicle.x:6.2f} m  y {vehicle.y:6.2f} m  heading {degrees(vehicle.heading):4.0f} deg"
    return f"{vehicle.speed:5.2f} m/s  {place}  rolled {vehicle.distance:.1f} m"
