"""info, type, find and node: what they make of the graph."""

import pytest

from zteleop.bus.presence import Endpoint, Member
from zteleop.cli import graph, info, node_info
from zteleop.cli._graph import Graph, find_node, types_of
from zteleop.errors import BusError, ConfigError

TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def end(topic: str, kind: str, node: str, type_: str, robot: str = "abe") -> Endpoint:
    return Endpoint(robot, kind, node, "pi-7", type_, topic)


HERE = Graph(
    [
        end("cmd_vel/keyboard", "pub", "keyboard", STAMPED),
        end("cmd_vel/keyboard", "sub", "actuator", STAMPED),
        end("drive_status", "pub", "actuator", "zteleop/msg/DriveStatus"),
        end("chatter", "sub", "echo", "any"),
        end("drive_status", "pub", "actuator", "zteleop/msg/DriveStatus", "bob"),
    ],
    [
        Member("abe", "actuator", "pi-7"),
        Member("abe", "keyboard", "mac-1"),
        Member("abe", "keyboard", "mac-2"),
        Member("bob", "actuator", "pi-8"),
    ],
    "abe",
    [
        Endpoint("abe", "srv", "lights", "pi-9", "std_srvs/srv/SetBool", "lights"),
        Endpoint("bob", "srv", "lights", "pi-9", "std_srvs/srv/SetBool", "lights"),
        Endpoint("bob", "srv", "doors", "pi-9", "std_srvs/srv/Trigger", "doors/left"),
    ],
    [Member("abe", "actuator", "pi-7")],
)


def test_the_types_of_a_topic_are_those_it_is_made_for_and_those_that_are_told() -> None:
    assert types_of(HERE.topic("cmd_vel")[1]) == [STAMPED, TWIST]
    assert types_of([end("chatter", "pub", "x", "std_msgs/msg/String")]) == ["std_msgs/msg/String"]
    assert types_of(HERE.topic("chatter")[1]) == ["any"]


def test_a_topic_without_a_robot_is_the_only_one_there_is_or_both_are_named() -> None:
    nowhere = HERE._replace(robot=None)
    assert str(nowhere.topic("chatter")[0]) == "abe/chatter"
    assert str(nowhere.topic("/bob/drive_status")[0]) == "bob/drive_status"
    words = "several have 'drive_status': /abe/drive_status, /bob/drive_status; say which"
    with pytest.raises(BusError, match=words):
        nowhere.topic("drive_status")
    with pytest.raises(ConfigError, match="topic 'scan' names no robot"):
        nowhere.topic("scan")


def test_a_topic_is_told_in_the_words_of_ros() -> None:
    _, members = HERE.topic("cmd_vel")
    counts = [f"Type: {STAMPED}, {TWIST}", "Publisher count: 1", "Subscription count: 1"]
    assert list(info.lines(members, verbose=False)) == counts
    assert list(info.lines(members, verbose=True)) == [
        counts[0],
        "",
        counts[1],
        "",
        "Node name: keyboard",
        "Node namespace: /abe",
        "Process: pi-7",
        "Topic: /abe/cmd_vel/keyboard",
        f"Topic type: {STAMPED}",
        "Endpoint type: PUBLISHER",
        "",
        counts[2],
        "",
        "Node name: actuator",
        "Node namespace: /abe",
        "Process: pi-7",
        "Topic: /abe/cmd_vel/keyboard",
        f"Topic type: {STAMPED}",
        "Endpoint type: SUBSCRIPTION",
    ]


def test_one_who_says_a_command_by_several_keys_is_one_and_its_keys_stand_together() -> None:
    twists = [end(f"cmd_vel/{source}", "sub", "actuator", STAMPED) for source in ("keyboard", "program")]
    other = end("cmd_vel/program", "sub", "actuator", TWIST)
    listener = end("cmd_vel/**", "sub", "echo", STAMPED)
    assert list(info.lines([*twists, other, listener], verbose=False))[1:] == [
        "Publisher count: 0",
        "Subscription count: 2",
    ]
    said = list(info.lines([*twists, other], verbose=True))
    assert "Topic: /abe/cmd_vel/keyboard, /abe/cmd_vel/program" in said
    assert f"Topic type: {STAMPED}, {TWIST}" in said


def test_a_topic_that_nobody_has_is_unknown_and_the_nearest_is_told() -> None:
    with pytest.raises(BusError, match=r"Unknown topic '/abe/drive_statu'; did you mean drive_status"):
        HERE.topic("drive_statu")
    with pytest.raises(BusError, match="'/eve/odom'; robot eve is not heard; heard here: abe, bob"):
        HERE.topic("/eve/odom")


def test_a_node_is_told_with_all_its_processes() -> None:
    assert list(node_info.lines(*find_node("keyboard", HERE.nodes, HERE.robot), HERE)) == [
        "/abe/keyboard",
        "  Subscribers:",
        "  Publishers:",
        f"    /abe/cmd_vel/keyboard: {STAMPED}",
        "  Service Servers:",
        "  Processes:",
        "    mac-1",
        "    mac-2",
    ]


@pytest.mark.parametrize("text", ["actuator", "abe/actuator", "/abe/actuator"])
def test_a_node_is_the_one_of_the_robot_meant(text: str) -> None:
    assert find_node(text, HERE.nodes, HERE.robot) == ("abe", "actuator")
    assert find_node("/bob/actuator", HERE.nodes, HERE.robot) == ("bob", "actuator")


def test_a_node_of_several_robots_or_of_none_is_asked_about() -> None:
    with pytest.raises(
        BusError, match="2 nodes are called actuator: /abe/actuator, /bob/actuator; say which"
    ):
        find_node("actuator", HERE.nodes, None)
    with pytest.raises(BusError, match="Unable to find node 'keybord'; did you mean /abe/keyboard"):
        find_node("keybord", HERE.nodes, HERE.robot)


def test_a_graph_is_an_arrow_for_each_topic() -> None:
    assert list(graph.as_text(HERE)) == [
        "/abe/chatter       nobody -> echo",
        "/abe/cmd_vel       keyboard -> actuator",
        "/abe/drive_status  actuator -> nobody",
        "/bob/drive_status  actuator -> nobody",
    ]


def test_a_graph_can_be_drawn_whatever_a_stranger_calls_himself() -> None:
    dot = list(graph.as_dot(HERE._replace(endpoints=[*HERE.endpoints, end("x", "pub", 'a"b', "any")])))
    assert (dot[0], dot[-1]) == ("digraph zteleop {", "}")
    assert '  "/abe/cmd_vel" [shape=box];' in dot
    assert '  "/abe/keyboard" -> "/abe/cmd_vel";' in dot
    assert '  "/abe/cmd_vel" -> "/abe/actuator";' in dot
    assert '  "/abe/a\\"b" -> "/abe/x";' in dot


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("lights", "/abe/lights"),
        ("/bob/lights", "/bob/lights"),
        ("doors/left", "/bob/doors/left"),
        ("bob/doors/left", "/bob/doors/left"),
        ("actuator/get_parameters", "/abe/actuator/get_parameters"),
        ("/abe/actuator/list_parameters", "/abe/actuator/list_parameters"),
    ],
)
def test_a_service_is_the_one_of_the_robot_meant_or_the_only_one(text: str, found: str) -> None:
    name, servers = HERE.service(text)
    assert (f"/{name}", len(servers)) == (found, 1)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("lihgts", r"Unknown service 'lihgts'; did you mean /bob/lights or /abe/lights\?"),
        (
            "keyboard/get_parameters",
            "Unknown service 'keyboard/get_parameters'; did you mean /abe/actuator/get_",
        ),
    ],
)
def test_a_service_of_nobody_is_asked_about(text: str, words: str) -> None:
    with pytest.raises(BusError, match=words):
        HERE.service(text)


def test_a_service_of_several_robots_is_asked_about() -> None:
    with pytest.raises(BusError, match="several serve 'lights': /abe/lights, /bob/lights; say which"):
        HERE._replace(robot=None).service("lights")
    with pytest.raises(BusError, match="Unknown service 'lights'; there is none here"):
        Graph([], [], None).service("lights")


def test_a_node_is_told_with_what_it_answers() -> None:
    shown = list(node_info.lines("bob", "doors", HERE))
    assert shown[shown.index("  Service Servers:") + 1] == "    /bob/doors/left: std_srvs/srv/Trigger"
    shown = list(node_info.lines("abe", "actuator", HERE))
    assert "    /abe/actuator/set_parameters: rcl_interfaces/srv/SetParameters" in shown
