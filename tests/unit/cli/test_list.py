from zteleop.bus.presence import Endpoint
from zteleop.cli.list import _by_topic, _line


def end(topic: str, kind: str = "pub", type_: str = "nav_msgs/msg/Odometry", robot: str = "abe") -> Endpoint:
    return Endpoint(robot, kind, "nose", "pi-7", type_, topic)


def test_topics_stand_in_order_each_once() -> None:
    ends = [end("odom", robot="zoe"), end("odom"), end("odom", "sub"), end("chatter")]
    found = _by_topic(ends)
    assert list(found) == ["/abe/chatter", "/abe/odom", "/zoe/odom"]
    assert found["/abe/odom"] == ends[1:3]


def test_a_commands_sources_are_one_topic_under_each_of_its_names() -> None:
    ends = [end("cmd_vel/web"), end("cmd_vel/keyboard"), end("cmd_vel/**", "sub")]
    assert _by_topic(ends) == {"/abe/cmd_vel": ends, "/abe/cmd_vel_stamped": ends}
    assert list(_by_topic([end("pwm/web")])) == ["/abe/controls", "/abe/pwm"]


def test_a_line_is_a_name_and_perhaps_its_types() -> None:
    members = [end("x", type_="b"), end("x", type_="a"), end("x", type_="b")]
    assert _line("/abe/x", members, False) == "/abe/x"
    assert _line("/abe/x", members, True) == "/abe/x [a, b]"
