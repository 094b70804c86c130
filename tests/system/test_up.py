"""`zteleop up`: a robot and its world by one command."""

import os
import signal
import sys

from rig import NEUTRAL, Rig, until

from zteleop.messages import Odometry, Twist

LAUNCH = """
[launch]
world = "sim {join}"
robot = "actuator --robot bench --no-multicast-scouting --listen {endpoint}"
"""


def launched(rig: Rig, own: str = "") -> None:
    rig.set(LAUNCH.format(join=" ".join(rig.bus_options()), endpoint=rig.endpoint) + own)


def test_a_robot_and_its_world_start_together_and_end_in_order_wheels_first(rig: Rig) -> None:
    launched(rig)
    up = rig.run("up")
    until(lambda: "robot | actuator: info: bench obeys" in up.text, "a robot")
    until(lambda: "world | " in up.text, "a world")
    node = rig.node("driver")
    odom = node.subscription("odom", Odometry)
    rig.hear(node)
    motors = node.publisher("cmd_vel", Twist)

    def driven() -> bool:
        motors.publish(Twist.planar(0.5))
        said = odom.newest()
        return said is not None and said.twist.twist.linear.x > 0.1

    until(driven, "a car that moves")
    theirs = children(up.process.pid)
    up.signal(signal.SIGINT)
    assert up.ends() == 130
    assert rig.ticks == NEUTRAL
    rest = up.text.index("bench is at rest, its chip reads neutral")
    assert "world |" not in up.text[rest:] or rest < up.text.rindex("world |")
    assert not any(os.path.exists(f"/proc/{pid}") for pid in theirs), "nobody is left"


def test_what_is_killed_is_started_again(rig: Rig) -> None:
    launched(rig)
    up = rig.run("up")
    until(lambda: "bench obeys" in up.text, "a robot")
    (robot,) = [pid for pid in children(up.process.pid) if b"actuator" in command(pid)]
    up.signal(signal.SIGTSTP)  # after which it would start nothing again
    until(lambda: "Ctrl-Z would pause nothing that it started" in up.text, "words")
    os.kill(robot, signal.SIGKILL)
    until(lambda: "robot | ended with signal 9; starts again in 0.1 s" in up.text, "words")
    until(lambda: up.text.count("bench obeys") == 2, "the robot again")
    up.signal(signal.SIGTERM)
    assert up.ends() == 128 + signal.SIGTERM


def test_a_robot_whose_starter_is_killed_ends_at_rest_and_so_does_any_program(rig: Rig) -> None:
    (rig.folder / "own.py").write_text("import time; print('own runs', flush=True); time.sleep(600)")
    launched(rig, f"own = '{sys.executable} own.py'")
    up = rig.run("up")
    until(lambda: "bench obeys" in up.text and "| own runs" in up.text, "a robot and a program")
    theirs = children(up.process.pid)
    up.signal(signal.SIGKILL)
    until(lambda: not any(os.path.exists(f"/proc/{pid}") for pid in theirs), "nobody is left")
    assert rig.ticks == NEUTRAL


def test_without_anything_to_start_it_says_what_to_write(rig: Rig) -> None:
    result = rig.result("up")
    assert (result.returncode, result.stdout) == (1, "")
    assert 'nothing to start: write [launch] into config.toml, such as robot = "actuator"' in result.stderr


def children(pid: int) -> list[int]:
    with open(f"/proc/{pid}/task/{pid}/children") as file:
        return [int(child) for child in file.read().split()]


def command(pid: int) -> bytes:
    with open(f"/proc/{pid}/cmdline", "rb") as file:
        return file.read()
