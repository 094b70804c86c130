import os

import pytest
import zenoh
from unit.bus.fakes import Session

from zteleop.bus import presence
from zteleop.bus.names import Name, resolve
from zteleop.bus.presence import Endpoint
from zteleop.bus.session import Sample
from zteleop.messages import Message, Pwm, Twist, TwistStamped


@pytest.mark.parametrize("kind", ["pub", "sub"])
@pytest.mark.parametrize(
    ("name", "types", "told"),
    [
        (resolve("archangel/odom", None), (), [("any", "odom")]),
        (resolve("archangel/pwm/web", None), (Pwm,), [("zteleop_msgs/msg/Pwm", "pwm/web")]),
        (
            Name("archangel", "cmd_vel/**"),
            (TwistStamped, Twist),
            [("geometry_msgs/msg/Twist", "cmd_vel/**"), ("geometry_msgs/msg/TwistStamped", "cmd_vel/**")],
        ),
    ],
)
def test_what_a_node_tells_of_itself_is_read_back(
    kind: presence.Kind, name: Name, types: tuple[type[Message], ...], told: list[tuple[str, str]]
) -> None:
    key = presence.endpoint_key(name, kind, "nose", types)
    where = "archangel", kind, "nose", presence.process()
    assert presence.endpoints(Session([key])) == [Endpoint(*where, *one) for one in told]


def test_of_too_many_types_the_first_are_remembered() -> None:
    key = "robot/abe/live/pub/nose/pi-7/" + ",".join(f"a.msg.T{number}" for number in range(99)) + "/soil"
    assert [one.type for one in presence.endpoints_of(key)] == [f"a/msg/T{n}" for n in range(presence.TYPES)]


def test_no_token_is_a_wildcard() -> None:
    key = presence.endpoint_key(Name("archangel", "cmd_vel/**"), "sub", "nose", [Twist])
    assert "*" not in key
    assert str(zenoh.KeyExpr(key)) == key


def test_a_process_is_its_host_and_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(presence.socket, "gethostname", lambda: "pi.local/é*" + "x" * 100)
    assert presence.process() == f"pi-local---{'x' * 21}-{os.getpid()}"


def test_robots_come_and_go() -> None:
    session = Session([])
    robots = presence.Robots(session)
    token = "robot/{}/live/node/actuator/{}".format
    came = [token("zoe", "pi-1"), token("abe", "pi-2"), token("abe", "pi-3"), token("no robot", "pi-4")]
    session.comings.samples += [Sample(key, b"", "") for key in came]
    assert robots.there() == ["abe", "zoe"]
    session.comings.samples += [Sample(key, b"", "", is_put=False) for key in (came[0], came[1], "robot/x")]
    assert robots.there() == ["abe"]


def test_endpoints_are_told_once_and_in_order() -> None:
    keys = [
        presence.endpoint_key(resolve(topic, None), "pub", "nose", [Twist])
        for topic in ("zoe/odom", "abe/odom", "abe/imu")
    ]
    found = presence.endpoints(Session(keys + keys))
    assert [(end.robot, end.topic) for end in found] == [("abe", "imu"), ("abe", "odom"), ("zoe", "odom")]


@pytest.mark.parametrize(
    "key",
    [
        "robot/archangel/live/pub",
        "robot/archangel/live/pub/nose",
        "robot/archangel/live/sub/nose/host-1/any",
        "robot/archangel/live/pub/nose/host-1/any/\x1b[2J",
        "robot/\x1b[2J/live/pub/nose/host-1/any/odom",
        "robot/*/live/pub/nose/host-1/any/odom",
        "robot/archangel/live/other/nose/host-1/any/live/pub/odom",
    ],
)
def test_a_strangers_token_is_left_out(key: str) -> None:
    assert presence.endpoints(Session([key])) == []


def test_robots_are_those_with_an_actuator() -> None:
    keys = [presence.node_key(*who) for who in (("zoe", "actuator"), ("abe", "actuator"), ("bob", "camera"))]
    assert presence.robots(Session(keys)) == ["abe", "zoe"]


def test_what_cannot_be_a_robots_name_is_none() -> None:
    names = ("*", "**", "\x1b[2J", "ABE", "é", "x" * 64)
    assert presence.robots(Session(f"robot/{name}/live/node/actuator/pi-7" for name in names)) == []


def test_holders_are_the_processes_of_one_node_of_one_robot() -> None:
    keys = [
        "robot/abe/live/node/actuator/pi-7",
        "robot/abe/live/node/actuator/laptop-3",
        "robot/abe/live/node/camera/pi-8",
        "robot/zoe/live/node/actuator/pi-9",
    ]
    assert presence.holders(Session(keys), "abe", "actuator") == ["laptop-3", "pi-7"]
    assert presence.holders(Session(), "abe", "actuator") == []


@pytest.mark.parametrize("name", ["*", "**", "pi\x1b[2J"])
def test_a_stranger_is_no_holder_of_every_robots_nodes(name: str) -> None:
    keys = [f"robot/abe/live/node/actuator/{name}", "robot/*/live/node/actuator/pi-7"]
    assert presence.holders(Session(keys), "abe", "actuator") == []


def test_a_sender_is_a_node_of_a_process() -> None:
    tokens = [
        presence.sender_key("abe", 0x7F, "nose"),
        "robot/abe/live/sender/80",
        "robot/abe/live/sender/1/2/3/4",
    ]
    found = presence.senders(Session(tokens), "abe")  # type: ignore[arg-type]
    assert found == {"7f": ("abe", "nose", presence.process())}


def test_everybody_is_found_by_one_question() -> None:
    name = Name("abe", "lights")
    tokens = [
        presence.node_key("abe", "nose"),
        presence.parameters_key("abe", "nose"),
        presence.service_key(name, "nose", "std_srvs/srv/SetBool"),
        presence.endpoint_key(Name("abe", "odom"), "pub", "nose", []),
        presence.endpoint_key(Name("abe", "odom"), "sub", "nose", []),
        presence.sender_key("abe", 7, "nose"),
        "robot/abe/live/node/too/many/parts",
    ]
    session = Session(tokens)
    found = presence.everybody(session)  # type: ignore[arg-type]
    assert [(one.kind, one.topic) for one in found.endpoints] == [("pub", "odom"), ("sub", "odom")]
    assert found.nodes == found.with_parameters == [("abe", "nose", presence.process())]
    assert [(one.topic, one.type) for one in found.services] == [("lights", "std_srvs/srv/SetBool")]
    assert found.nodes == presence.nodes(session)  # type: ignore[arg-type]
    assert found.services == presence.services(session)  # type: ignore[arg-type]
