"""Reads the simulated chip as a car would, moves in its scene, and says where it is."""

from collections.abc import Callable
from math import degrees
from random import Random
from typing import NamedTuple

from msgspec.structs import replace

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.mixer import Ackermann
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.drivers.registers import read_pulse_us
from zteleop.drivers.simulated import open_registers
from zteleop.errors import ConfigError
from zteleop.messages import Header, Odometry, Range, String
from zteleop.nodes.battery import give_power
from zteleop.nodes.create3 import Equipment
from zteleop.nodes.picture import take_pictures
from zteleop.sim import make_vehicle
from zteleop.sim.battery import Battery, BatterySettings
from zteleop.sim.body import Body
from zteleop.sim.camera import Camera
from zteleop.sim.car import Car
from zteleop.sim.create3.body import Create3
from zteleop.sim.inertial import Inertial
from zteleop.sim.noise import NONE, Noise
from zteleop.sim.odometer import Odometer
from zteleop.sim.plan import plan, to_text
from zteleop.sim.ranges import RangeSensor
from zteleop.sim.scene import Scene
from zteleop.sim.unknown import unknown
from zteleop.sim.world import World

CREATE3 = ("create3", "create3_full")
PERIOD, AT_REST = 0.01, 0.05
"""s between two looks at the chip, and while the vehicle stands"""
STANDS = 0.001
"""m/s, or rad/s"""
TELL_EVERY = 1.0
SEEN_EVERY = 0.1
HARDLY = 0.05
"""degrees that nobody sees"""
STANDS_BELOW = 0.001
"""m between two looks"""


class Simulated(NamedTuple):
    """What is simulated: of a Create 3 all that such a robot has; and where, if there is a scene."""

    kind: str = ""
    scene: Scene | None = None
    noise: Noise = NONE
    seed: int = 0
    unknown: bool = False
    """its servo and its ESC are not what the settings say"""
    camera: bool = False
    """it has one, and says what that sees"""
    charge: float = 1.0
    """of its battery at the start"""


def run(
    node: Node,
    settings: DriveSettings,
    path: str,
    show: Callable[[str], None] = print,
    simulated: Simulated | None = None,
) -> None:
    """Move a vehicle by the pulses in a register file until the node is stopped, and show how it moves.

    Raises ConfigError for a scene in which it does not fit.
    """
    simulated = simulated or Simulated()
    if simulated.camera:
        simulated = simulated._replace(scene=simulated.scene or Scene())
    if simulated.unknown:
        vehicle: Body = unknown_car(settings, simulated.seed)
    elif simulated.kind in CREATE3:
        vehicle = Create3(settings.servos, settings.mixer.max_speed)
    else:
        vehicle = make_vehicle(settings.mixer, settings.servos)
    vehicle.odometer = Odometer(simulated.noise, Random(simulated.seed))
    world = furnish(node, vehicle, simulated) if simulated.scene else None
    if world and simulated.camera:
        take_pictures(node, Camera(simulated.scene or Scene()), world)
    if isinstance(vehicle, Create3):
        Equipment(node, vehicle, world, Inertial(simulated.noise, Random(simulated.seed)), simulated.charge)
    else:
        give_power(node, vehicle, Battery(BatterySettings(percentage=simulated.charge)))
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

    if simulated.unknown and isinstance(vehicle, Car):
        node.every(SEEN_EVERY)(Wheels(vehicle, show).look)
    rolled, moved = 0.0, False

    @node.every(TELL_EVERY)
    def show_motion() -> None:
        nonlocal rolled, moved
        moves = vehicle.distance - rolled >= STANDS_BELOW
        if moves or moved:
            show(motion(vehicle))
        rolled, moved = vehicle.distance, moves

    node.spin()


def unknown_car(settings: DriveSettings, seed: int) -> Car:
    """Return a car to calibrate; raises ConfigError for settings that make none."""
    if not isinstance(settings.mixer, Ackermann):
        raise ConfigError("--unknown is for a car, with steering and throttle")
    # the same car for a seed, whatever has been found out of it meanwhile
    channels = {name: servo.channel for name, servo in settings.servos.items()}
    really = unknown({name: replace(DONKEYCAR[name], channel=channels[name]) for name in DONKEYCAR}, seed)
    return Car(settings.mixer, really.servos, really.settings)


class Wheels:
    """Tells what somebody would see who watches the wheels of a car: where they point, and how they turn."""

    def __init__(self, car: Car, show: Callable[[str], None]) -> None:
        self._car = car
        self._show = show
        self._told = ""

    def look(self) -> None:
        """Say it when it is another than before."""
        angle = degrees(self._car.steering_angle)
        side = "left" if angle > 0 else "right"
        points = f"{abs(angle):.1f} deg to the {side}" if abs(angle) >= HARDLY else "straight ahead"
        words = f"its wheels point {points}, and turn at {self._car.speed:.2f} m/s"
        if words != self._told:
            self._told = words
            self._show(words)


def furnish(node: Node, vehicle: Body, simulated: Simulated) -> World:
    """Put a vehicle into its scene; say what that is, what it hits, and how far it is to what is ahead."""
    scene = simulated.scene or Scene()
    world = vehicle.room = World(scene, vehicle.discs)
    sensor, chance = RangeSensor(), Random(simulated.seed)
    text = to_text(plan(scene))
    scenes, ranges = node.publisher("scene", String), node.publisher("range", Range)
    told = ""

    node.every(TOPICS["scene"].every)(lambda: scenes.publish(String(text)))

    @node.every(TOPICS["range"].every)
    def look() -> None:
        nonlocal told
        ahead = sensor.measure(world, world.nose)
        header = Header(clock.stamp(), "range")
        ranges.publish(sensor.state(header, ahead, chance, simulated.noise.range))
        touched = world.contact.name if world.contact and world.pushed else ""
        world.pushed = False
        if touched and touched != told:
            node.log.warn(f"it stands at {scene.called(touched)}, and can only drive away from there")
        told = touched

    return world


def motion(vehicle: Body) -> str:
    """Return in a line how a vehicle moves, and where it is."""
    place = f"x {vehicle.x:6.2f} m  y {vehicle.y:6.2f} m  heading {degrees(vehicle.heading):4.0f} deg"
    return f"{vehicle.speed:5.2f} m/s  {place}  rolled {vehicle.distance:.1f} m"
