"""Drive one circle and say how wide it was.

A car turns no tighter than its steering allows: the default one 0.6 m.
"""

from math import atan2, remainder, tau

from zteleop import Node, Odometry, Twist

RADIUS, SPEED = 1.0, 1.0  # m, m/s

xs: list[float] = []
headings: list[float] = []
turned = 0.0

print(f"drives a circle of {2 * RADIUS:g} m at {SPEED:g} m/s: {tau * RADIUS / SPEED:.0f} s", flush=True)

with Node("circle", robot="archangel") as node:
    motors = node.publisher("cmd_vel", Twist)

    @node.every(0.05)
    def drive() -> None:
        motors.publish(Twist.planar(SPEED, SPEED / RADIUS))

    @node.on("odom", Odometry)
    def look(odometry: Odometry) -> None:
        global turned
        pose = odometry.pose.pose
        xs.append(pose.position.x)
        headings.append(2 * atan2(pose.orientation.z, pose.orientation.w))
        # from one odometry to the next it turns by little: the short way round is the one it took
        turned += remainder(headings[-1] - headings[max(-2, -len(headings))], tau)
        if turned >= tau:
            node.stop()

    node.spin()
    motors.let_go()

print(f"one circle, {max(xs) - min(xs):.2f} m wide; {2 * RADIUS:.2f} m were meant")
