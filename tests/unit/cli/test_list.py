from zteleop.bus.presence import Endpoint
from zteleop.cli.list import _line


def end(topic: str, kind: str = "pub", type_: str = "nav_msgs/msg/Odometry", robot: str = "abe") -> Endpoint:
    return Endpoint(robot, kind, "nose", "pi-7", type_, topic)


def test_a_line_is_a_name_and_perhaps_its_types() -> None:
    members = [end("x", type_="b"), end("x", type_="a"), end("x", type_="b")]
    assert _line("/abe/x", members, False) == "/abe/x"
    assert _line("/abe/x", members, True) == "/abe/x [a, b]"
