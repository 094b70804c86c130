import pytest

from zteleop.bus.presence import Endpoint, Member
from zteleop.cli import GROUPS, VERBS, completion, main
from zteleop.cli._completing import candidates
from zteleop.cli._graph import Graph
from zteleop.errors import BusError

HERE = Graph(
    [
        Endpoint("abe", "pub", "actuator", "pi-7", "nav_msgs/msg/Odometry", "odom"),
        Endpoint("abe", "pub", "x", "pi-7", "any", "\x1b[2J"),
        Endpoint("zoe", "pub", "garden", "pi-7", "acme_msgs/msg/Soil", "soil", "11"),
    ],
    [Member("abe", "actuator", "pi-7"), Member("bob", "watchdog", "pi-8")],
    "abe",
    [Endpoint("abe", "srv", "lights", "pi-7", "std_srvs/srv/SetBool", "lights")],
    [Member("abe", "actuator", "pi-7")],
)


@pytest.fixture(autouse=True)
def bus(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    asked: list[object] = []

    class Found:
        def __init__(self, arguments: object) -> None:
            asked.append(arguments)

        def __enter__(self) -> Graph:
            return HERE

        def __exit__(self, *exc: object) -> None:
            pass

    monkeypatch.setattr("zteleop.cli._graph.graph", Found)
    return asked


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["ec"], ["echo"]),
        (["no"], ["node"]),
        (["node", ""], ["info", "list"]),
        (["topic", "b"], ["bw"]),
        (["echo", ""], ["abe/odom", "zoe/soil"]),
        (["topic", "echo", "ab"], ["abe/odom"]),
        (["hz", "abe/odom", ""], ["abe/odom", "zoe/soil"]),
        (["hz", "/a"], ["/abe/odom"]),
        (["echo", "od"], ["odom"]),
        (["service", "call", "/abe/li"], ["/abe/lights"]),
        (["service", "call", "li"], ["lights"]),
        (["service", "call", "abe/li"], ["abe/lights"]),
        (["pub", "soil", "ac"], ["acme_msgs/msg/Soil"]),
        (["interface", "show", "acme"], ["acme_msgs/msg/Soil"]),
        (["service", "type", "/abe/actuator/g"], ["/abe/actuator/get_parameters", "/abe/actuator/get_time"]),
        (["service", "call", "lights", "std_srvs/srv/S"], ["std_srvs/srv/SetBool"]),
        (["param", "set", "/a"], ["/abe/actuator"]),
        (["echo", "--once", "a"], ["abe/odom"]),
        (["echo", "--robot", ""], ["abe", "bob"]),
        (["stop", "b"], ["bob"]),
        (["node", "info", "/b"], ["/bob/watchdog"]),
        (["node", "info", "w"], ["watchdog"]),
        (["node", "info", "bob/"], ["bob/watchdog"]),
        (["echo", "odom", "nav_msgs/msg/O"], ["nav_msgs/msg/Odometry"]),
        (["pub", "odom", "nav_msgs/msg/O"], ["nav_msgs/msg/Odometry"]),
        (["keyboard", "--drive", ""], ["hold", "step"]),
        (["echo", "odom", "--fl"], ["--flow-style"]),
        (["echo", "odom", "--field", "p"], ["pose"]),
        (["echo", "odom", "--field", "pose.pose."], ["pose.pose.orientation", "pose.pose.position"]),
        (["echo", "odom", "--field", "pose.nose."], []),
        (["echo", "soil", "--field", ""], []),
        (["echo", "--field", ""], []),
        (["echo", "odom", "Odometry", ""], []),
        (["fly", ""], []),
        (["check", "--config", ""], []),
        (["topic", "fly", ""], []),
    ],
)
def test_a_word_goes_on_as_it_may(words: list[str], found: list[str]) -> None:
    assert candidates(words) == found


def test_the_first_word_is_any_verb_or_group() -> None:
    assert candidates([""]) == sorted({verb.partition(" ")[0] for verb in VERBS} | GROUPS.keys())


def test_the_bus_is_asked_where_the_options_say(bus: list[object]) -> None:
    candidates(["echo", "--connect", "tcp/pi:7447", "a"])
    candidates(["echo", "--mode", "nonsense", "a"])
    assert [arguments.connect for arguments in bus] == [["tcp/pi:7447"], None]  # type: ignore[attr-defined]


def test_where_the_bus_cannot_be_joined_nothing_is_offered(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(arguments: object) -> None:
        raise BusError("no router")

    monkeypatch.setattr("zteleop.cli._graph.graph", fail)
    assert candidates(["echo", ""]) == []


@pytest.mark.parametrize("shell", completion.SCRIPTS)
def test_each_shell_has_a_script_that_asks_for_words(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    assert f"zteleop completion {shell} -- " in capsys.readouterr().out
    assert main(["completion", shell, "--", "echo", "--onc"]) == 0
    assert capsys.readouterr().out == "--once\n"
