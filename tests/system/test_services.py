"""What nodes answer and let others change: programs of their own, a robot behind its door, and the verbs."""

import os
import re
import signal
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Process, Rig, until

from zteleop.bus.node import Node
from zteleop.errors import BusError
from zteleop.messages import (
    DriveStatus,
    GetParametersRequest,
    GetParametersResponse,
    SetBoolRequest,
    SetBoolResponse,
    Twist,
)

LIGHTS = """
from zteleop import BusSettings, Node
from zteleop.messages import SetBoolRequest, SetBoolResponse

with Node("lights", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False)) as node:
    bright = node.parameter("brightness", 0.5, "share of full light", least=0.0, most=1.0)

    def switch(asked: SetBoolRequest) -> SetBoolResponse:
        if asked.data and not bright.value:
            raise RuntimeError("the lamp is dark")
        node.log.debug("switches")
        return SetBoolResponse(asked.data, f"on, at {{bright.value:.0%}}" if asked.data else "off")

    node.service("lights", SetBoolRequest, SetBoolResponse, switch)
    print("ready", flush=True)
    node.spin()
"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("services")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def lights(rig: Rig) -> Process:
    process = rig.program(LIGHTS.replace("{endpoint}", rig.endpoint).replace("{{", "{").replace("}}", "}"))
    process.says("ready")
    return process


@pytest.fixture(scope="module")
def node(rig: Rig) -> Node:
    node = rig.node()
    rig.hear(node)
    return node


def asks(rig: Rig, *words: str) -> tuple[int, str, str]:
    """Type a verb; return its exit code, and what it said and complained of."""
    found = rig.result(*words, *rig.bus_options())
    return found.returncode, found.stdout, found.stderr


def test_whoever_asks_is_answered_and_a_handler_that_raises_ends_nothing(
    rig: Rig, lights: Process, node: Node
) -> None:
    until(lambda: "/bench/lights\n" in asks(rig, "service", "list")[1], "the service")
    assert node.call("lights", SetBoolRequest(True), SetBoolResponse) == SetBoolResponse(True, "on, at 50%")
    assert asks(rig, "param", "set", "lights", "brightness", "0.0")[0] == 0
    with pytest.raises(BusError, match=r"^/bench/lights refuses: its handler failed: RuntimeError: the lamp"):
        node.call("lights", SetBoolRequest(True), SetBoolResponse)
    assert node.call("lights", SetBoolRequest(False), SetBoolResponse).message == "off"
    assert asks(rig, "param", "set", "lights", "brightness", "1.0")[0] == 0


def test_a_service_is_asked_from_a_shell_in_the_words_of_ros(rig: Rig, lights: Process) -> None:
    assert asks(rig, "service", "call", "/bench/lights", "std_srvs/srv/SetBool", "{data: true}") == (
        0,
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='on, at 100%')\n\n",
        "",
    )
    assert asks(rig, "service", "type", "lights") == (0, "std_srvs/srv/SetBool\n", "")
    assert asks(rig, "service", "find", "SetBool") == (0, "/bench/lights\n", "")
    assert "/bench/lights [std_srvs/srv/SetBool]\n" in asks(rig, "service", "list", "-t")[1]
    assert "/bench/actuator/set_parameters\n" in asks(rig, "service", "list", "-a")[1]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("service", "call", "lihgts", "SetBool"), "Unknown service 'lihgts'; did you mean /bench/lights?"),
        (
            ("service", "call", "lights", "SetBol"),
            "no service type 'SetBol'; did you mean std_srvs/srv/SetBool?",
        ),
        (("service", "call", "lights", "SetBool", "{date: 1}"), "SetBoolRequest has no field 'date'"),
        (
            ("service", "call", "lights", "Trigger"),
            "/bench/lights refuses: expected std_srvs/srv/SetBool_Request",
        ),
        (("param", "get", "lights", "brigthness"), "has no parameter 'brigthness'; did you mean brightness?"),
        (("param", "get", "light", "brightness"), "Unable to find node 'light'; did you mean /bench/lights?"),
        (("param", "set", "lights", "brightness", "2"), "failed: brightness: expected 0 to 1, found 2.0"),
        (("param", "set", "lights", "brightness", "{"), "expected YAML such as"),
        (("param", "load", "lights", "none.yaml"), "cannot read none.yaml: No such file or directory"),
    ],
)
def test_what_cannot_be_is_one_sentence(rig: Rig, lights: Process, words: tuple[str, ...], told: str) -> None:
    code, _, error = asks(rig, *words)
    assert (code, error.count("\n")) == (1, 1 + error.count("waits for ")), error
    assert told in error


def test_whoever_does_not_spin_is_named(rig: Rig, lights: Process, node: Node) -> None:
    os.kill(lights.process.pid, signal.SIGSTOP)
    try:
        with pytest.raises(
            BusError,
            match=r"^lights on \S+ did not answer /bench/lights within 0.2 s: it is busy, or does not spin",
        ):
            node.call("lights", SetBoolRequest(True), SetBoolResponse, 0.2)
    finally:
        os.kill(lights.process.pid, signal.SIGCONT)


def test_a_node_that_does_not_spin_hides_the_parameters_of_no_other(
    rig: Rig, lights: Process, node: Node
) -> None:
    until(lambda: "/bench/lights\n" in asks(rig, "service", "list")[1], "the service")
    code, said, error = asks(rig, "param", "list")
    assert code == 1, "this test's own does not"
    assert f"/bench/{node.name}:\n/bench/watchdog:\n  log_level\n" in said
    assert "/bench/lights:\n  brightness\n  log_level\n/bench/" in said
    assert re.fullmatch(rf"zteleop param list: {node.name} on \S+ did not answer .*\n", error)


def test_parameters_are_shown_changed_kept_and_set_again(rig: Rig, lights: Process) -> None:
    assert asks(rig, "param", "list", "lights")[1] == "  brightness\n  log_level\n"
    assert asks(rig, "param", "set", "lights", "brightness", "0.25")[1] == "Set parameter successful\n"
    assert asks(rig, "param", "get", "/bench/lights", "brightness")[1] == "Double value is: 0.25\n"
    _, dumped, _ = asks(rig, "param", "dump", "lights")
    assert dumped == "/bench/lights:\n  ros__parameters:\n    brightness: 0.25\n    log_level: info\n"
    (rig.folder / "lights.yaml").write_text(dumped.replace("0.25", "0.75").replace("/bench/", "/"))
    assert "Set parameter brightness successful\n" in asks(rig, "param", "load", "lights", "lights.yaml")[1]
    assert asks(rig, "param", "get", "lights", "brightness", "--hide-type")[1] == "0.75\n"
    assert "    Max value: 1.0\n" in asks(rig, "param", "describe", "lights", "brightness")[1]
    lights.says("brightness is 0.75 now, and was 0.25")


def test_a_log_tells_more_when_it_is_asked_to(rig: Rig, lights: Process, node: Node) -> None:
    assert "switches" not in lights.text
    assert asks(rig, "param", "set", "lights", "log_level", "debug")[0] == 0
    node.call("lights", SetBoolRequest(False), SetBoolResponse)
    lights.says("lights: debug: switches")


def test_a_robot_is_slowed_down_while_it_drives_and_stays_so(rig: Rig, node: Node) -> None:
    motors = node.publisher("cmd_vel", Twist)
    statuses = node.subscription("drive_status", DriveStatus)

    def drives_at(speed: float) -> bool:
        motors.publish(Twist.planar(1.0))
        found = statuses.newest()
        return found is not None and found.state == "driving" and abs(found.applied.linear.x - speed) < 0.01

    until(lambda: drives_at(1.0), "1 m/s")
    request = GetParametersRequest(["limits.speed"])
    assert (
        node.call("/bench/actuator/get_parameters", request, GetParametersResponse).values[0].double_value
        == 3.0
    )
    assert asks(rig, "param", "set", "actuator", "limits.speed", "0.3") == (
        0,
        "Set parameter successful\n",
        "",
    )
    until(lambda: drives_at(0.3), "0.3 m/s")
    assert "limits.speed is set to 0.3 m/s" in asks(rig, "why")[1]
    motors.let_go()
    until(lambda: rig.ticks == NEUTRAL, "rest")
    assert asks(rig, "param", "get", "actuator", "deadlines.operator")[1] == "Double value is: 5.0\n"
    told = asks(rig, "param", "set", "actuator", "limits.speed", "3.5")
    assert (told[0], "expected 0.03 to 3, found 3.5" in told[2]) == (1, True)


def test_what_was_set_outlives_an_actuator_that_is_killed(rig: Rig) -> None:
    assert asks(rig, "param", "set", "actuator", "limits.speed", "0.4")[0] == 0
    (child,) = {pid for pid in rig.pids if pid} & set(_actuators(rig))
    os.kill(child, signal.SIGKILL)
    until(lambda: _actuators(rig) and _actuators(rig) != [child], "another actuator")
    until(lambda: asks(rig, "param", "get", "actuator", "limits.speed")[1] == "Double value is: 0.4\n", "0.4")
    assert asks(rig, "param", "set", "actuator", "limits.speed", "3.0")[0] == 0
    assert list(rig.folder.glob("state_home/zteleop/robots/bench/limits.json")) == []


def _actuators(rig: Rig) -> list[int]:
    return [process.child for process in rig._processes if process.child]


def test_what_a_full_stick_means_is_changed_from_elsewhere_and_by_keys(rig: Rig) -> None:
    keyboard = rig.keyboard("--drive", "hold")
    keyboard.shows("full      0.50 m/s")
    assert asks(rig, "param", "set", "keyboard", "speeds.forward", "0.2")[0] == 0
    keyboard.shows("full      0.20 m/s")
    keyboard.type("u")
    keyboard.shows("full      0.22 m/s")
    until(
        lambda: asks(rig, "param", "get", "keyboard", "speeds.forward", "--hide-type")[1][:4] == "0.22",
        "0.22",
    )
    keyboard.type("q")
    assert keyboard.ends() == 0
