"""One more of each, by the words of docs/house.md alone: a file in the room, and one line in its table."""

import re
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import ClassVar

import pytest

from zteleop import chaos, drivers
from zteleop.bus import codec
from zteleop.bus.topics import TOPICS, Topic, topic_of
from zteleop.cameras import CAMERAS, Source, Wanted, sources
from zteleop.chaos.fault import Fault
from zteleop.cli import VERBS, main
from zteleop.control.stick import Speeds, Stick
from zteleop.drivers import DRIVERS, PulseDriver, open_driver
from zteleop.inputs.keymap import KEYMAPS, bindings
from zteleop.messages import Message, Vehicle
from zteleop.nodes.teleop import Teleop
from zteleop.processes import PROGRAMS, Program
from zteleop.processes.__main__ import main as run_program
from zteleop.testing import Clock, FakeNode

HOUSE = Path(__file__).parents[2] / "docs/house.md"
ELSEWHERE = {"kind of vehicle": "test_third_kind", "deadline": "test_deadlines"}

Room = Callable[[str, str, str], None]


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Room:
    """Return what puts a file of a test's own into a room of the house."""

    def put(package: str, name: str, text: str) -> None:
        (tmp_path / f"{name}.py").write_text(text)
        house = import_module(package)
        monkeypatch.setattr(house, "__path__", [*house.__path__, str(tmp_path)])
        monkeypatch.delitem(sys.modules, f"{package}.{name}", raising=False)

    return put


VERB = """
EXAMPLES = ("zteleop greet ann",)
def add_arguments(parser): parser.add_argument("who")
def run(arguments): print("hello", arguments.who)
"""


def test_a_verb(room: Room, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    room("zteleop.cli", "greet", VERB)
    monkeypatch.setitem(VERBS, "greet", "say hello")
    assert main(["greet", "ann"]) == 0
    assert main(["--help"]) == 0
    assert re.match(r"hello ann\n[^§]*\n  greet +say hello\n", capsys.readouterr().out)


def test_a_key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KEYMAPS["all"], "h", "forward")
    assert bindings({})["h"] == "forward"


class Metronome:
    """A device that asks for half the speed, always."""

    drive, speeds = "hold", Speeds(forward=1.0)
    finished = rested = False
    wish = None

    def fileno(self) -> None: ...
    def fit(self, vehicle: Vehicle) -> None: ...
    def reset(self, now: float) -> None: ...

    def read(self, now: float) -> bool:
        return True

    def stick(self, now: float) -> Stick:
        return Stick(0.5, 0.0, True)


def test_a_device_to_drive_with(tank: Vehicle, clock: Clock) -> None:
    node = FakeNode()
    teleop = Teleop(node, Metronome(), "metronome", tank, lambda view: None)
    teleop.obey()
    assert node.said["cmd_vel"].messages[-1].twist.linear.x == tank.max_speed / 2


CHIP = """
import msgspec
class Settings(msgspec.Struct): pins: int = 2
SETTINGS = Settings
class Pins:
    def __init__(self, pins): self.widths = {channel: None for channel in range(pins)}
    def write(self, pulse_us): self.widths |= pulse_us
    def read(self, channels): return {channel: self.widths[channel] for channel in channels}
def open_driver(settings, *, exclusive=True): return Pins(settings.pins)
"""


def test_a_chip(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    room("zteleop.drivers", "pins", CHIP)
    monkeypatch.setitem(DRIVERS, "pins", "zteleop.drivers.pins")
    chip: PulseDriver = open_driver("pins", {"pins": 3})
    chip.write({2: 1500.0})
    assert chip.read([1, 2]) == {1: None, 2: 1500.0}
    with pytest.raises(drivers.ConfigError, match=r"drivers.pins.pins: expected a whole number, found"):
        open_driver("pins", {"pins": "three"})


def test_a_kind_of_camera(monkeypatch: pytest.MonkeyPatch) -> None:
    bird = Source("what a bird sees", ("fly", "high"))
    monkeypatch.setitem(CAMERAS, "bird", lambda device, wanted: iter([bird]))
    assert sources("bird", Wanted()) == [bird]


class Bell(Message):
    """A bell that rings."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Bell"

    strokes: int


def test_a_message(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(TOPICS, "bell", Topic("bell", (Bell,)))
    accepted = codec.decoders(topic_of("bell").types)
    assert codec.decode(codec.encode(Bell(3)), codec.encoding_of(Bell), accepted) == Bell(3)


def test_a_thing_that_can_go_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    people = import_module("zteleop.chaos.people")
    tripped = Fault("somebody trips over the cable", lambda bench: None)
    monkeypatch.setattr(people, "FAULTS", (*people.FAULTS, tripped))
    assert ("people", tripped) in list(chaos.faults())


def test_a_program_that_belongs_to_a_robot(
    room: Room, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    room("zteleop.processes", "horn", "def run(file): print('hoots into', file); return 0")
    monkeypatch.setitem(PROGRAMS, "horn", Program("the watchdog", 0, 500, "nobody hears it"))
    assert run_program(["horn", "7"]) == 0
    assert capsys.readouterr().out == "hoots into 7\n"


def test_each_of_them_is_added_somewhere() -> None:
    part = HOUSE.read_text().split("## Which room to open")[1]
    rows = re.findall(r"^\| ([a-z][a-z ]+) \|", part, re.MULTILINE)[1:]
    here = {
        name.removeprefix("test_a_").replace("_", " ") for name in globals() if name.startswith("test_a_")
    }
    assert here | ELSEWHERE.keys() == set(rows)
