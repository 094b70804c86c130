import pytest
from unit.bus.fakes import Session

from zteleop.bus.names import Name, resolve
from zteleop.bus.presence import Endpoint, Kind, here, process, who_is_here
from zteleop.cli._company import (
    by_topic,
    disagreements,
    meets,
    members,
    who_hears,
    why_silent,
)


def end(
    topic: str, kind: Kind = "pub", node: str = "nose", where: str = "pi-7", robot: str = "abe"
) -> Endpoint:
    return Endpoint(robot, kind, node, where, "nav_msgs/msg/Odometry", topic)


ABE = [end("odom"), end("log"), end("cmd_vel/keyboard", "sub", "actuator"), end("scan", "sub", "map")]
ZOE = [end("odom", robot="zoe")]


def test_topics_stand_in_order_each_once() -> None:
    ends = [end("odom", robot="zoe"), end("odom"), end("odom", "sub"), end("chatter")]
    found = by_topic(ends)
    assert list(found) == ["/abe/chatter", "/abe/odom", "/zoe/odom"]
    assert found["/abe/odom"] == ends[1:3]


def test_a_commands_sources_and_names_are_one_topic() -> None:
    ends = [end("cmd_vel/web"), end("cmd_vel/keyboard"), end("cmd_vel/**", "sub")]
    assert by_topic(ends) == {"/abe/cmd_vel": ends}
    assert members(resolve("abe/cmd_vel_stamped", None), "pub", ends) == ends[:2]
    assert members(resolve("abe/cmd_vel", None), "sub", ends) == ends[2:]


@pytest.mark.parametrize(
    ("topic", "words"),
    [
        ("abe/odom", "nose on pi-7 publishes it, and says nothing now"),
        ("abe/odmo", "nobody publishes it; did you mean odom?"),
        ("abe/cmdvel", "nobody publishes it; did you mean cmd_vel?"),
        ("abe/cmd_vel", "nobody publishes it now"),
        ("abe/rosout", "nobody publishes it; known: log, odom"),
        (
            "abe/stop",
            "nobody publishes it now; it is said only when somebody stops a robot: "
            "zteleop why tells which stops are in force",
        ),
        (
            "abee/odom",
            "nobody publishes it; robot abee is not heard; heard here: abe, zoe; did you mean abe?",
        ),
    ],
)
def test_a_silence_says_who_says_nothing_or_what_was_meant(topic: str, words: str) -> None:
    mine = [end("odmo", "sub", "echo", process()), end("odom", "sub", "echo", process(), "abee")]
    astray = end("odom", "sub", "echo", "pi-9", "abee")  # somebody else waits for that robot, too
    assert why_silent(resolve(topic, None), [*mine, astray, *ABE, *ZOE]) == words


def test_where_a_robot_is_somebody_else_says_than_its_actuator() -> None:
    actuator = [end("drive_status", "pub", "actuator")]
    words = "nobody publishes it now; zteleop sim says it of a simulated robot, zteleop odometry of any other"
    assert why_silent(resolve("abe/odom", None), actuator) == words


def test_who_drives_in_one_way_is_silent_on_the_topic_of_the_other() -> None:
    keys = [end(topic, "pub", "keyboard") for topic in ("cmd_vel/keyboard", "pwm/keyboard")]
    words = "keyboard on pi-7 publishes it, and says nothing now; while somebody drives, it may speak on"
    assert why_silent(resolve("abe/cmd_vel", None), keys) == f"{words} pwm instead"
    assert why_silent(resolve("abe/pwm", None), keys) == f"{words} cmd_vel instead"


def test_a_stop_that_was_said_is_told_by_why_whoever_may_say_it() -> None:
    words = why_silent(resolve("abe/stop", None), [end("stop", "pub", "keyboard")])
    assert words.endswith("only when somebody stops a robot: zteleop why tells which stops are in force")


def test_two_who_say_nothing_are_two() -> None:
    two = [end("odom"), end("odom", where="pi-8"), end("odom", where="pi-8")]
    assert why_silent(resolve("abe/odom", None), two) == (
        "nose on pi-7 and nose on pi-8 publish it, and says nothing now"
    )


def test_where_nobody_is_there_no_robot_is_heard() -> None:
    assert why_silent(resolve("abe/odom", None), []) == (
        "nobody publishes it; robot abe is not heard; no actuator is heard here"
    )


@pytest.mark.parametrize(
    ("topic", "words"),
    [
        ("abe/scan", "map on pi-7 hears it"),
        ("abe/scna", "nobody hears it; did you mean scan or scene?"),
        ("abe/cmdvel", "nobody hears it; did you mean cmd_vel?"),
        ("abe/odom", "nobody hears it now"),
        ("abe/soil", "nobody hears it now"),
        ("zeo/scan", "nobody hears it; robot zeo is not heard; heard here: abe, zoe; did you mean zoe?"),
    ],
)
def test_who_speaks_is_told_who_hears_or_what_was_meant(topic: str, words: str) -> None:
    mine = end("scan", "pub", "pub", process(), "zeo")
    assert who_hears(resolve(topic, None), [mine, *ABE, *ZOE]) == words


def test_robots_that_are_here_are_named_once_in_order() -> None:
    assert who_is_here(["zoe", "abe", "zoe"]) == "heard here: abe, zoe"
    assert who_is_here(["zoe", "abe"], "student") == "heard here: abe, zoe"


def typed(kind: str, node: str, ros_type: str, digest: str = "", topic: str = "soil") -> Endpoint:
    return Endpoint("abe", kind, node, "pi-7", ros_type, topic, digest)


@pytest.mark.parametrize(
    ("speaker", "hearer", "told"),
    [
        (("a/msg/Soil", "11"), ("a/msg/Soil", "11"), []),
        (("a/msg/Soil", "11"), ("any", ""), []),
        (
            ("a/msg/Soil", "11"),
            ("a/msg/Soil", "22"),
            ["nose on pi-7 says a/msg/Soil 11; ear on pi-7 hears 22 alone, and drops it"],
        ),
        (
            ("a/msg/Soil", "11"),
            ("std_msgs/msg/String", ""),
            ["nose on pi-7 says a/msg/Soil; ear on pi-7 hears std_msgs/msg/String alone, and drops it"],
        ),
    ],
)
def test_who_disagree_about_a_type_are_told_by_name(
    speaker: tuple[str, str], hearer: tuple[str, str], told: list[str]
) -> None:
    members = [typed("pub", "nose", *speaker), typed("sub", "ear", *hearer)]
    assert list(disagreements(members)) == told


def test_who_hears_one_of_several_types_drops_the_others_and_who_hears_all_drops_none() -> None:
    said = [typed("pub", "nose", "a/msg/Soil", "11"), typed("pub", "nose", "std_msgs/msg/String", "")]
    ear = [typed("sub", "ear", one.type, one.hash) for one in said]
    assert list(disagreements([*said, *ear])) == []
    (words,) = disagreements([*said, *ear[:1]])
    assert words.startswith("nose on pi-7 says std_msgs/msg/String; ear on pi-7 hears a/msg/Soil alone")


def test_two_who_publish_one_topic_in_two_ways_are_told_where_nobody_hears_it() -> None:
    members = [typed("pub", "nose", "a/msg/Soil", "11"), typed("pub", "toe", "a/msg/Soil", "22")]
    assert list(disagreements(members)) == ["nose on pi-7 says a/msg/Soil 11; toe on pi-7 says 22"]
    assert list(disagreements([*members[:1], typed("pub", "toe", "a/msg/Soil", "11")])) == []


def test_a_command_of_two_types_is_no_disagreement() -> None:
    members = [
        typed("pub", "nose", "geometry_msgs/msg/Twist", topic="cmd_vel/program"),
        typed("sub", "ear", "geometry_msgs/msg/TwistStamped", topic="cmd_vel/**"),
    ]
    assert list(disagreements(members)) == []


@pytest.mark.parametrize(
    ("path", "found"),
    [
        ("cmd_vel", ["keyboard", "nav", "ear", "all"]),
        ("cmd_vel/keyboard", ["keyboard", "all"]),
        ("cmd_vel/nav", ["nav", "ear", "all"]),
    ],
)
def test_the_name_of_one_source_means_that_one_and_the_plain_name_all(path: str, found: list[str]) -> None:
    everybody = [
        typed("pub", "keyboard", "any", topic="cmd_vel/keyboard"),
        typed("pub", "nav", "any", topic="cmd_vel/nav"),
        typed("sub", "ear", "any", topic="cmd_vel/nav"),
        typed("sub", "all", "any", topic="cmd_vel/**"),
        typed("pub", "sim", "any", topic="odom"),
    ]
    assert [one.node for one in everybody if meets(Name("abe", path), one)] == found


def test_an_endpoint_at_which_nobody_answers_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    session = Session()
    assert here(session, "abe") == "no actuator is heard here"  # type: ignore[arg-type]
    monkeypatch.setattr(session, "unreached", lambda: ["tcp/pi:7447"])
    assert here(session, "abe").startswith("nothing answers at tcp/pi:7447")  # type: ignore[arg-type]
