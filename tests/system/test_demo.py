"""`zteleop demo`: everything in one, and nothing of it left behind."""

import os
import re
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from rig import Process, Rig, Terminal, until

UP = "\x1b[A"
WALL = re.compile(r"([⠉⠒⠤⣀])\1{4}")


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """A folder with the settings of a real robot, which a demo must leave alone."""
    with Rig(tmp_path_factory.mktemp("demo")) as bench:
        (bench.folder / "config.toml").write_text(
            f'driver = "pca9685"\n[drivers.simulated]\npath = "{bench.chip}"\n'
        )
        yield bench


class Pair(NamedTuple):
    figure: Process
    """the one run without a terminal; it takes ten seconds, in which the others run beside it"""
    robot: str
    screen: Terminal


@pytest.fixture(scope="module", autouse=True)
def pair(rig: Rig) -> Pair:
    """Two demos begun at once."""
    figure, screen = rig.run("demo"), rig.terminal("demo")
    return Pair(figure, robot_of(figure), screen)


@pytest.fixture
def screen(rig: Rig) -> Terminal:
    terminal = rig.terminal("demo")
    terminal.shows("step drive", "idle, nobody operates", "place")
    return terminal


def processes(robot: str) -> list[str]:
    """Return the processes of a robot, as the whole machine tells."""
    return [line for line in map(command_line, Path("/proc").glob("[0-9]*")) if robot in line.split()]


def command_line(process: Path) -> str:
    try:
        return (process / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
    except OSError:  # it ended meanwhile
        return ""


def children(demo: Process) -> str:
    """Return the command lines of a demo's children."""
    numbers = Path(f"/proc/{demo.process.pid}/task/{demo.process.pid}/children").read_text().split()
    return " ".join(command_line(Path("/proc", number)) for number in numbers)


def robot_of(demo: Process) -> str:
    """Return the robot that a demo has made up, by what its children are told."""
    name = re.compile(r"--robot (demo-[0-9a-f]{4}) ")
    until(lambda: name.search(children(demo)), "the children of a demo")
    return name.search(children(demo))[1]  # type: ignore[index]


def leaves_nothing(robot: str) -> None:
    until(lambda: not processes(robot), f"the end of {processes(robot)}")


def test_two_demos_at_once_do_not_disturb_each_other(pair: Pair) -> None:
    figure, robot, screen = pair
    screen.shows("idle, nobody operates", "place     x 0.00")
    figure.says(" driving ")
    assert "nobody operates" in screen.screen
    assert robot_of(screen) != robot
    screen.type(UP * 20)
    screen.shows("[375, 393]", "driving, you operate", "moving    +0.")
    screen.type("q")
    assert screen.ends() == 0
    assert processes(robot) or figure.ends() == 0, "it drives on, or has driven to its end"


@pytest.mark.parametrize("key", ["q", "\x03"], ids=["q", "Ctrl-C"])
def test_a_key_ends_all_of_it(screen: Terminal, key: str) -> None:
    robot = robot_of(screen)
    assert robot in screen.screen
    assert len(processes(robot)) == 2, "an actuator and a simulator"
    screen.type(UP * 3)
    screen.shows("[375, 376]", "driving, you operate", "out       throttle 376")
    screen.type(key)
    assert screen.ends() == 0
    assert processes(robot) == []
    screen.is_as_found()


def after_the_screen(demo: Terminal) -> str:
    """Return the last words of a demo, on the terminal that it gave back."""
    return "drove" + demo.output.decode().replace("\r", "").rpartition("drove")[2]


def test_the_first_press_moves_the_car_and_the_end_says_what_was_driven_and_what_comes_next(
    rig: Rig,
) -> None:
    found = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    screen = rig.terminal("demo", environment={"PATH": found})
    screen.shows("step drive", "idle, nobody operates", "place")
    screen.type(UP)
    screen.shows("[375, 374]", "place     x 0.1")
    screen.type("q")
    assert screen.ends() == 0
    last = after_the_screen(screen)
    assert re.match(r"drove 0\.\d m, 0\.\d\d m/s at most\ntry next:\n", last)
    told = re.findall(r"^  (zteleop [-\w ]+?)  +\w", last, re.MULTILINE)
    assert told == ["zteleop demo --drive hold", "zteleop keyboard --help", "zteleop doctor"]
    again = rig.terminal(*told[0].split()[1:], environment={"PATH": found})
    again.shows("hold drive", "idle, nobody operates")
    again.type("w")
    again.shows("moving    +0.")
    again.type("q")
    assert again.ends() == 0
    assert "zteleop demo --drive step" in after_the_screen(again)
    for command in told[1:]:
        assert rig.result(*command.split()[1:]).stdout


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_a_demo_that_is_ended_from_outside_leaves_no_process(screen: Terminal, number: int) -> None:
    robot = robot_of(screen)
    screen.type(UP)
    screen.shows("driving, you operate")
    screen.signal(number)
    assert screen.ends() == (128 + number if number == signal.SIGTERM else -number)
    leaves_nothing(robot)


def test_a_demo_leaves_the_robot_of_the_config_file_alone(rig: Rig, screen: Terminal) -> None:
    assert rig.ticks == (None, None), "the chip of the config file was woken"
    screen.type("q")
    assert screen.ends() == 0


@pytest.mark.parametrize(
    ("verb", "part", "words"), [("sim", "simulator", ""), ("actuator", "robot", "{robot} is gone")]
)
def test_a_demo_of_which_a_part_is_gone_says_so_and_what_to_do(
    screen: Terminal, verb: str, part: str, words: str
) -> None:
    robot = robot_of(screen)
    numbers = Path(f"/proc/{screen.process.pid}/task/{screen.process.pid}/children").read_text().split()
    (child,) = (int(pid) for pid in numbers if f" {verb} " in command_line(Path(f"/proc/{pid}")))
    os.kill(child, signal.SIGKILL)
    screen.shows(f"demo: its {part} ended: q, and start another", words.format(robot=robot))
    assert "zteleop actuator" not in screen.screen, "which would be another robot"
    screen.type("q")
    assert screen.ends() == 0


def test_a_tank_is_driven_in_a_maze(rig: Rig) -> None:
    screen = rig.terminal("demo", "--vehicle", "tank", "--scene", "maze")
    screen.shows("hold drive", "left 368, right 368")
    screen.type(UP)
    until(lambda: WALL.search(screen.screen) and "x 0.00 " not in screen.screen, "motion, beside a wall")
    screen.type("q")
    assert screen.ends() == 0


def test_a_demo_on_a_bad_radio_drives_and_says_how_late_its_commands_come(rig: Rig) -> None:
    screen = rig.terminal("demo", "--drive", "step", "--latency", "150ms", "--loss", "5%", columns=110)
    screen.shows("idle, nobody operates", "place")
    screen.type(UP)
    shown = screen.shows("driving, you operate", "commands arrive within")
    late = re.search(r"commands arrive within (\d+) ms", shown)
    assert late
    assert int(late[1]) > 150
    screen.type("q")
    assert screen.ends() == 0


def test_a_scene_that_is_none_starts_nothing(rig: Rig) -> None:
    demo = rig.run("demo", "--scene", "mazze")
    assert demo.ends() == 1
    assert demo.lines == [
        "zteleop demo: no scene 'mazze', nor a file such as ./room.toml; did you mean maze?"
    ]


def test_without_a_terminal_it_drives_a_figure_and_ends_by_itself(pair: Pair) -> None:
    figure, robot, _ = pair
    assert figure.ends() == 0
    assert figure.lines[0] == "no terminal: driving a figure of eight for 10 s"
    assert re.fullmatch(r"drove [1-9]\.\d m and stopped", figure.lines[-1])
    assert processes(robot) == []
