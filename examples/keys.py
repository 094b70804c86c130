"""Drive with keys: u faster, j slower, i more to the left, k more to the right, space rest, q end."""

import curses

from zteleop import Node, Twist

STEPS = {"u": (0.1, 0.0), "j": (-0.1, 0.0), "i": (0.0, 0.1), "k": (0.0, -0.1)}
"""m/s and rad/s that a key adds"""


def drive(screen: "curses.window") -> None:
    screen.nodelay(True)
    with Node("keys", robot="archangel") as node:
        motors = node.publisher("cmd_vel", Twist)
        speed = turn = 0.0

        @node.every(0.05)
        def look() -> None:
            nonlocal speed, turn
            code = screen.getch()
            key = chr(code) if code >= 0 else ""
            if key == "q":
                node.stop()
            elif key == " ":
                speed = turn = 0.0
            faster, further = STEPS.get(key, (0.0, 0.0))
            speed, turn = round(speed + faster, 1), round(turn + further, 1)
            # Only a key is an act: who presses none for 5 s is no longer there, and the robot rests.
            (motors.publish if key else motors.repeat)(Twist.planar(speed, turn))
            screen.addstr(0, 0, f"{speed:+.1f} m/s  {turn:+.1f} rad/s   u j speed, i k turn, space, q ")
            screen.refresh()

        node.spin()
        motors.let_go()


curses.wrapper(drive)
