from zteleop.bus.presence import Endpoint
from zteleop.cli.list import _line, _with_people


def end(topic: str, kind: str = "pub", type_: str = "nav_msgs/msg/Odometry", robot: str = "abe") -> Endpoint:
    return Endpoint(robot, kind, "nose", "pi-7", type_, topic)


def test_a_line_is_a_name_and_perhaps_its_types() -> None:
    members = [end("x", type_="b"), end("x", type_="a"), end("x", type_="b")]
    assert _line("/abe/x", members, False) == "/abe/x"
    assert _line("/abe/x", members, True) == "/abe/x [a, b]"


def test_with_people_it_is_in_the_words_of_ros_and_names_them() -> None:
    twist = "geometry_msgs/msg/Twist"
    told = [
        end("odom"),
        end("cmd_vel/program", type_=twist),
        end("cmd_vel/program", "sub", twist),
        end("cmd_vel/keyboard", "sub", twist),
    ]
    assert list(_with_people(told)) == [
        "Published topics:",
        " * /abe/cmd_vel [geometry_msgs/msg/Twist] 1 publisher, also cmd_vel_stamped",
        "     nose on pi-7: cmd_vel/program",
        " * /abe/odom [nav_msgs/msg/Odometry] 1 publisher",
        "     nose on pi-7",
        "",
        "Subscribed topics:",
        " * /abe/cmd_vel [geometry_msgs/msg/Twist] 1 subscriber, also cmd_vel_stamped",
        "     nose on pi-7: cmd_vel/program",
        "     nose on pi-7: cmd_vel/keyboard",
    ]
