"""Reads the simulated chip as a car would, moves, and says where it is."""

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.settings import DriveSettings
from zteleop.drivers.registers import read_pulse_us
from zteleop.drivers.simulated import open_registers
from zteleop.messages import Odometry
from zteleop.sim import make_vehicle

PERIOD = 0.01


def run(node: Node, settings: DriveSettings, path: str) -> None:
    """Move a vehicle by the pulses in a register file until the node is stopped."""
    vehicle = make_vehicle(settings.mixer, settings.servos)
    registers = open_registers(path)
    odoms = node.publisher("odom", Odometry)
    channels = [servo.channel for servo in settings.servos.values()]
    then = clock.now()

    @node.every(PERIOD)
    def move() -> None:
        nonlocal then
        now = clock.now()
        snapshot = registers.snapshot()
        vehicle.step({channel: read_pulse_us(snapshot, channel) for channel in channels}, now - then)
        then = now

    @node.every(TOPICS["odom"].every)
    def tell() -> None:
        odoms.publish(vehicle.odometry(clock.stamp()))

    node.spin()
