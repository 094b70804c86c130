"""Drive in a curve until Ctrl-C."""

from zteleop import Node, Twist

with Node("pub_motor", robot="archangel") as node:
    motors = node.publisher("cmd_vel", Twist)

    @node.every(0.1)  # a robot that hears nothing for 0.5 s stops
    def turn() -> None:
        motors.publish(Twist.planar(linear=0.3, angular=0.3))

    node.spin()
