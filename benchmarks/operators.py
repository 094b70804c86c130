"""Three kinds of operator who drive a robot straight on for as long as they are let."""

import subprocess
import sys
from collections.abc import Callable

from places import Place
from robot import ROBOT, UP, Operator, Robot

REPEAT_AFTER, REPEAT_EVERY = 0.5, 0.033
"""s from the press of a key to its first repeat, and from one repeat to the next, as terminals do"""
TWIST = "{linear: {x: 0.3}}"
PROGRAM = """
import sys
from zteleop import BusSettings, Node, Twist

robot, endpoint = sys.argv[1:]
with Node("pub_motor", robot, BusSettings(connect=[endpoint], multicast=False)) as node:
    motors = node.publisher("cmd_vel", Twist)

    @node.every(0.05)
    def drive() -> None:
        motors.publish(Twist.planar(linear=0.3))

    node.spin()
"""
Tend = Callable[[float], object]
"""Does what an operator's hands do, if it is time."""


class PlacedRobot(Robot):
    """A robot at a place of its own."""

    def __init__(self, place: Place) -> None:
        super().__init__()
        self._place, self.endpoint = place, place.endpoint()

    def start_actuator(self) -> "subprocess.Popen[str]":
        return self.start_program([*self._place.robot, *self.command("actuator", "--listen", self.endpoint)])

    def typed(self, verb: str, *arguments: str) -> list[str]:
        """Return a verb as the operator types it."""
        return [*self._place.operator, *self.command(verb, "--connect", self.endpoint, *arguments)]

    def typed_python(self, program: str) -> list[str]:
        """Return a program as the operator runs it."""
        return [*self._place.operator, sys.executable, "-c", program, ROBOT, self.endpoint]


class Finger:
    """Holds a key down; the terminal repeats it."""

    def __init__(self, operator: Operator) -> None:
        self._operator, self._due, self._pressed = operator, 0.0, False

    def tend(self, now: float) -> None:
        """Send the key when it is due; what is late is not made up for, as in a terminal."""
        if now >= self._due:
            self._operator.type(UP)
            self._due = now + (REPEAT_EVERY if self._pressed else REPEAT_AFTER)
            self._pressed = True


def hold_key(robot: PlacedRobot) -> Tend:
    """Hold a key on the keyboard's screen."""
    return Finger(Operator(robot, robot.typed("keyboard", "--drive", "hold"))).tend


def publish(robot: PlacedRobot) -> Tend:
    """Say a command at 10 Hz, from a shell."""
    robot.start_program(robot.typed("pub", "cmd_vel", "Twist", TWIST, "-r", "10"))
    return _nothing


def run_program(robot: PlacedRobot) -> Tend:
    """Run a program such as README's, at 20 Hz."""
    robot.start_program(robot.typed_python(PROGRAM))
    return _nothing


def _nothing(now: float) -> None:
    """Leave it to the process."""


OPERATORS: dict[str, Callable[[PlacedRobot], Tend]] = {
    "keyboard": hold_key,
    "pub": publish,
    "program": run_program,
}
