"""Print where a robot is, until Ctrl-C."""

from zteleop import Node, Odometry

with Node("subscriber", robot="archangel") as node:

    @node.on("odom", Odometry)
    def show(odometry: Odometry) -> None:
        place, speed = odometry.pose.pose.position, odometry.twist.twist.linear.x
        print(f"x {place.x:.2f} m, y {place.y:.2f} m, {speed:.2f} m/s", flush=True)

    node.spin()
