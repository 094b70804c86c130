"""Robots in tests: a node without a bus, a chip without wires, and time that passes when a test says so.

For a program that does something with a node:

    node = FakeNode(robot="archangel")
    turn_in_circles(node)
    node.live(3.0)  # three seconds of its timers, the first time at once
    assert len(node.said["cmd_vel"].messages) == 4

With a robot that obeys, in the same time:

    robot = SimulatedRobot(node)
    node.live(60.0)  # a minute of driving takes a second
    assert robot.distance > 10
"""

from zteleop.testing.chip import MemoryChip
from zteleop.testing.clock import Clock
from zteleop.testing.link import Link
from zteleop.testing.node import FakeNode, Inbox, Said
from zteleop.testing.robot import SimulatedRobot
from zteleop.testing.terminal import FakeTerminal

__all__ = ["Clock", "FakeNode", "FakeTerminal", "Inbox", "Link", "MemoryChip", "Said", "SimulatedRobot"]
