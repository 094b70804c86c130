"""Drive a metre ahead and back again, by what the robot says of where it is.

`test_there_and_back.py` tries the same function without a robot.
"""

from math import dist

from zteleop import Node, Odometry, Twist

METRE, SPEED = 1.0, 0.5  # m, m/s


def there_and_back(node: Node) -> None:
    """Say ten times a second what is wanted; turn back after a metre, and stop near the start."""
    motors = node.publisher("cmd_vel", Twist)
    start: list[tuple[float, float]] = []
    speed = SPEED

    @node.every(0.1)
    def drive() -> None:
        motors.publish(Twist.planar(speed))

    @node.on("odom", Odometry)
    def look(odometry: Odometry) -> None:
        nonlocal speed
        position = odometry.pose.pose.position
        here = position.x, position.y
        if not start:
            start.append(here)
        way = dist(start[0], here)
        if way >= METRE:
            speed = -SPEED
        elif speed < 0 and way < METRE / 10:
            motors.let_go()
            node.stop()


if __name__ == "__main__":
    with Node("there_and_back", robot="archangel") as node:
        there_and_back(node)
        node.spin()
    print("there and back")
