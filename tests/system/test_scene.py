"""A simulated robot in a scene: it stands before a wall, sees how far it is, and everybody is told."""

import re
import signal
from collections.abc import Iterator

import pytest
from rig import Process, Rig, until

WALL = re.compile(r"([⠉⠒⠤⣀])\1{15}")
ROOM = """
[[walls]]
points = [[1.5, -2.0], [1.5, 2.0]]
[[posts]]
at = [-1.0, 0.0]
"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("scene")) as bench:
        (bench.folder / "room.toml").write_text(ROOM)
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def sim(rig: Rig) -> Process:
    process = rig.join("sim", "--scene", "room.toml")
    process.says("is heard")
    return process


def ask(rig: Rig, *words: str) -> str:
    verb, *rest = words
    result = rig.result(verb, *rig.bus_options(), *rest)
    assert result.returncode == 0, result.stderr
    return str(result.stdout)


def sees(rig: Rig) -> float:
    """Return how far it is to what stands ahead."""
    return float(ask(rig, "echo", "range", "--once", "--field", "range").split()[0])


def test_it_stands_before_a_wall_and_drives_away_from_it(rig: Rig, sim: Process) -> None:
    keys = rig.keyboard()
    keys.shows("place     x 0.00")
    until(lambda: WALL.search(keys.screen), "the wall in the picture")
    far = sees(rig)
    assert 1.0 < far < 1.5
    driven = rig.result("drive", *rig.bus_options(), "0.5m/s", "--for", "5s")
    assert (driven.returncode, driven.stdout.count("went 1.")) == (1, 1), driven.stdout
    assert "it; does something stand in its way?" in " ".join(driven.stderr.split())
    sim.says("sim: warning: it stands at the brown wall, and can only drive away from there")
    keys.shows("it stands at the brown wall")
    told = sim.text.count("it stands at the brown wall")
    assert rig.result("drive", *rig.bus_options(), "0.5m/s", "--for", "2s").returncode == 1
    until(lambda: sim.text.count("it stands at the brown wall") > told, "the wall, once more")
    assert sees(rig) < 0.1
    assert "went 0." in ask(rig, "drive", "-0.5m/s", "--for", "1s")
    assert sees(rig) > 0.2
    keys.type("q")
    assert keys.ends() == 0


PROGRAM = """
from zteleop import BusSettings, Node, Twist

with Node("bold", robot={robot!r}, bus=BusSettings(connect=[{endpoint!r}], multicast=False)) as node:
    motors = node.publisher("cmd_vel", Twist)
    node.every(0.1)(lambda: motors.publish(Twist.planar(linear=0.5)))
    node.spin()
"""


def test_a_program_that_drives_against_a_wall_is_told(rig: Rig, sim: Process) -> None:
    program = rig.program(PROGRAM.format(robot=rig.robot, endpoint=rig.endpoint))
    program.says("bold: warning: robot bench does not move on, says its sim: it stands at the brown wall")
    program.signal(signal.SIGINT)
    program.ends()


@pytest.mark.parametrize(
    ("scene", "text", "words"),
    [
        ("mazze", None, "no scene 'mazze', nor a file such as ./room.toml; did you mean maze?"),
        ("none.toml", None, "cannot read none.toml: No such file or directory"),
        ("odd.toml", "floor = 3", "odd.toml: floor: Expected `str`, got `int`"),
        ("wals.toml", "[[wals]]", "wals.toml: no key 'wals'; did you mean walls?"),
        ("torn.toml", "[[", "torn.toml: not TOML: "),
        (
            "full.toml",
            "[[boxes]]\nat = [0.0, 0.0]",
            "a robot does not fit where the scene starts: boxes[0] is there",
        ),
    ],
)
def test_a_scene_that_is_none_is_said_in_a_sentence(
    rig: Rig, scene: str, text: str | None, words: str
) -> None:
    if text is not None:
        (rig.folder / scene).write_text(text)
    result = rig.result("sim", *rig.bus_options(), "--robot", "other", "--scene", scene)
    assert result.returncode == 1
    assert words in result.stderr.splitlines()[-1]
