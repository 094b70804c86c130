"""Each program in examples/ as people start it, beside a simulated robot on the default bus."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, ROOT, Process, Rig, Terminal, until

EXAMPLES = ROOT / "examples"
TESTS = {"test_there_and_back"}
TRIED = {
    "line_follower",
    "publisher",
    "subscriber",
    "circle",
    "keys",
    "donkeycar",
    "stranger",
    "there_and_back",
}


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("examples")) as bench:
        bench.robot = f"examples-{os.getpid()}"  # others may be on this network
        bench.run("actuator", "--robot", bench.robot).says("obeys")
        bench.run("sim", "--robot", bench.robot)
        yield bench


def text(rig: Rig, name: str) -> str:
    """Return a program as it stands, but for the robot's name."""
    program = (EXAMPLES / f"{name}.py").read_text()
    assert program.count('"archangel"') == 1
    return program.replace("archangel", rig.robot)


def start(rig: Rig, name: str) -> Process:
    return rig.program(text(rig, name))


def ends(process: Process, by: int) -> None:
    """End a program as people do, and see that it says nothing of its insides."""
    process.signal(by)
    process.ends()
    assert "Traceback" not in process.text


def test_each_program_is_tried_and_told() -> None:
    assert {path.stem for path in EXAMPLES.glob("*.py")} == TRIED | TESTS
    assert set(re.findall(r"\]\((\w+)\.py\)", (EXAMPLES / "README.md").read_text())) == TRIED | TESTS


def test_a_node_that_knows_nothing_of_zteleop_hears_the_robot(rig: Rig) -> None:
    stranger = start(rig, "stranger")
    stranger.says(f"robot/{rig.robot}/drive_status: ")
    assert "nobody drives" in stranger.text
    stranger.signal(signal.SIGINT)
    stranger.ends()


def test_a_program_is_tested_without_a_robot() -> None:
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "--rootdir",
        str(EXAMPLES),
        *map(str, EXAMPLES.glob("test_*.py")),
    ]
    tested = subprocess.run(command, cwd=EXAMPLES, capture_output=True, text=True, check=False)
    assert tested.returncode == 0, tested.stdout
    assert re.search(r"^\d passed", tested.stdout, re.MULTILINE), tested.stdout


def test_there_and_back_ends_where_it_began(rig: Rig) -> None:
    program = start(rig, "there_and_back")
    until(lambda: rig.ticks[1] > NEUTRAL[1], "the way there")
    until(lambda: rig.ticks[1] < NEUTRAL[1], "the way back")
    program.says("there and back")
    assert program.ends() == 0
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_the_publisher_drives_until_it_is_ended(rig: Rig) -> None:
    publisher = start(rig, "publisher")
    until(lambda: rig.ticks[0] != NEUTRAL[0] and rig.ticks[1] != NEUTRAL[1], "a curve")
    ends(publisher, signal.SIGINT)
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_the_subscriber_says_where_it_is(rig: Rig) -> None:
    subscriber = start(rig, "subscriber")
    subscriber.says(" m/s")
    assert re.search(r"^x -?\d+\.\d\d m, y -?\d+\.\d\d m, -?\d\.\d\d m/s$", subscriber.text, re.MULTILINE)
    ends(subscriber, signal.SIGINT)


def test_the_circle_is_as_wide_as_was_meant(rig: Rig) -> None:
    circle = start(rig, "circle")
    circle.says("one circle, ")
    assert circle.ends() == 0
    found = re.search(r"one circle, (\d\.\d\d) m wide; 2.00 m were meant", circle.text)
    assert found
    assert float(found[1]) == pytest.approx(2.0, rel=0.1)
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_keys_change_the_speed(rig: Rig) -> None:
    surroundings = rig.environment | {"TERM": "xterm-256color", "LC_ALL": "C.UTF-8"}
    keys = rig.keep(Terminal(["-c", text(rig, "keys")], surroundings, rig.folder))
    keys.shows("+0.0 m/s  +0.0 rad/s")
    keys.type("uu")
    keys.shows("+0.2 m/s  +0.0 rad/s")
    until(lambda: rig.ticks[1] != NEUTRAL[1], "motion")
    keys.type("ujik ")
    keys.shows("+0.0 m/s  +0.0 rad/s")
    until(lambda: rig.ticks == NEUTRAL, "rest")
    keys.type("q")
    assert keys.ends() == 0


def test_a_donkeycar_program_steers_by_pulses(rig: Rig) -> None:
    donkeycar = start(rig, "donkeycar")
    until(lambda: rig.ticks == (330, 380), "left")
    until(lambda: rig.ticks == (420, 380), "right")
    ends(donkeycar, signal.SIGTERM)
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_a_line_is_followed_by_what_the_camera_sees(tmp_path_factory: pytest.TempPathFactory) -> None:
    with Rig(tmp_path_factory.mktemp("line")) as rig:
        rig.robot = f"line-{os.getpid()}"
        rig.run("actuator", "--robot", rig.robot).says("obeys")
        sim = rig.run("sim", "--robot", rig.robot, "--scene", "track", "--camera")
        follower = start(rig, "line_follower")
        until(lambda: rig.ticks[1] > NEUTRAL[1] and rolled(sim) > 6, "the first bend")
        ends(follower, signal.SIGINT)
        until(lambda: rig.ticks == NEUTRAL, "rest")
        assert "no line" not in follower.text
        assert "it stands at" not in sim.text


def rolled(sim: Process) -> float:
    """Return how far a simulated robot says that it came, m."""
    return max(map(float, re.findall(r"rolled (\d+\.\d)", sim.text)), default=0.0)
