"""Types that only a program of somebody's has: shown, said and heard by whoever never imported them."""

from collections.abc import Iterator

import pytest
from rig import Process, Rig, until

SOIL = """
import sys
from typing import ClassVar
from zteleop import BusSettings, Message, Node

class Soil(Message):
    '''How wet the ground is.'''
    ros_type: ClassVar[str] = "acme_msgs/msg/Soil"
    moisture: float
    {more}

node = Node("{name}", robot="bench", bus=BusSettings(connect=["{endpoint}"], multicast=False))
with node:
    soil = node.publisher("soil", Soil)

    @node.every(0.1)
    def tell() -> None:
        soil.publish(Soil(0.5{values}))

    @node.on("soil", Soil)
    def hear(said: Soil) -> None:
        if said.moisture != 0.5:
            print("heard", said.moisture, flush=True)

    print("ready", flush=True)
    node.spin()
"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("types")) as bench:
        bench.actuator()
        yield bench


def garden(rig: Rig, name: str, more: str = "notes: list[str]", values: str = ", ['dry']") -> Process:
    text = SOIL.replace("{more}", more).replace("{values}", values).replace("{name}", name)
    process = rig.program(text.replace("{endpoint}", rig.endpoint))
    process.says("ready")
    return process


@pytest.fixture(scope="module")
def speaker(rig: Rig) -> Process:
    process = garden(rig, "garden")
    until(lambda: "soil" in asks(rig, "list")[1], "its topic")
    return process


def asks(rig: Rig, *words: str) -> tuple[int, str, str]:
    found = rig.result(*words, *rig.bus_options())
    return found.returncode, found.stdout, found.stderr


def test_what_it_is_made_of_is_told_by_whoever_speaks_it(rig: Rig, speaker: Process) -> None:
    assert asks(rig, "interface", "show", "acme_msgs/msg/Soil") == (
        0,
        "# How wet the ground is.\nfloat64 moisture\nstring[] notes\n",
        "",
    )
    assert asks(rig, "interface", "proto", "Soil")[1] == '"moisture: 0.0\nnotes: []\n"\n'


def test_it_is_said_from_a_shell(rig: Rig, speaker: Process) -> None:
    values = "{moisture: 0.25, notes: [wet]}"
    code, said, error = asks(rig, "pub", "soil", "acme_msgs/msg/Soil", values, "--once")
    assert (code, "publishing #1: Soil(moisture=0.25, notes=['wet'])" in said) == (0, True), error
    speaker.says("heard 0.25")
    code, _, error = asks(rig, "pub", "soil", "Soil", "{moisure: 0.25}", "--once")
    assert (code, error.count("\n")) == (1, 1)
    assert "Soil has no field 'moisure'; did you mean moisture?" in error


def test_a_type_that_nobody_speaks_is_one_sentence(rig: Rig, speaker: Process) -> None:
    code, _, error = asks(rig, "interface", "show", "acme_msgs/msg/Rain")
    assert (code, error.count("\n")) == (1, 1)
    assert "no message type 'acme_msgs/msg/Rain'" in error
    assert "nobody on the bus speaks it" in error


def test_a_type_of_ros_is_known_by_its_text(rig: Rig) -> None:
    assert "float32[] ranges" in asks(rig, "interface", "show", "sensor_msgs/msg/LaserScan")[1]


def test_who_disagree_are_named(rig: Rig, speaker: Process) -> None:
    assert "Types disagree" not in asks(rig, "topic", "info", "soil")[1]
    other = garden(rig, "field", "depth: int", ", 3")
    until(lambda: "field on" in asks(rig, "topic", "info", "soil")[1], "both")
    said = asks(rig, "topic", "info", "-v", "soil")[1]
    assert said.count("Types disagree: ") == 2
    assert said.count("Topic type hash: ") == 4
    speaker.says("warning: robot/bench/soil: dropped: not a acme_msgs/msg/Soil: ")
    speaker.says(" alone, and drops what is said here, acme_msgs/msg/Soil ")
    assert other.process.poll() is None


def test_who_says_another_type_is_told_that_it_is_dropped(rig: Rig, speaker: Process) -> None:
    _, _, error = asks(rig, "pub", "soil", "std_msgs/msg/Bool", "{data: true}", "--once")
    assert "hears acme_msgs/msg/Soil alone, and drops what is said here, std_msgs/msg/Bool" in error


def test_a_program_that_does_not_spin_tells_what_its_type_is_made_of(rig: Rig) -> None:
    text = SOIL.replace("acme_msgs/msg/Soil", "acme_msgs/msg/Sand").replace('"soil"', '"sand"')
    text = text.replace("node.spin()", "__import__('time').sleep(60)")
    for name, word in {"more": "", "values": "", "name": "desert", "endpoint": rig.endpoint}.items():
        text = text.replace(f"{{{name}}}", word)
    rig.program(text).says("ready")
    until(lambda: "sand" in asks(rig, "list")[1], "its topic")
    assert asks(rig, "interface", "show", "acme_msgs/msg/Sand")[:2] == (
        0,
        "# How wet the ground is.\nfloat64 moisture\n",
    )
