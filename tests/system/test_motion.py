"""Courses driven from a shell: by what odometry says, to their end, or to where the robot obeys no more."""

import re
import signal
from collections.abc import Iterator
from subprocess import CompletedProcess

import pytest
from rig import NEUTRAL, Process, Rig, until

from zteleop.text.quantity import quantity

TANK = """
[drive.mixer]
kind = "differential"
[drive.servos.left]
channel = 0
[drive.servos.right]
channel = 1
"""


@pytest.fixture(scope="module")
def car(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("car")) as bench:
        bench.actuator()
        bench.join("sim").says("is heard")
        yield bench


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("tank"), "tank") as bench:
        config = bench.folder / "config.toml"
        config.write_text(config.read_text() + TANK)
        bench.actuator()
        bench.join("sim").says("is heard")
        yield bench


def ask(rig: Rig, line: str) -> "CompletedProcess[str]":
    verb, *words = line.split()
    return rig.result(verb, *rig.bus_options(), *words)


def numbers(said: str) -> list[float]:
    return [float(text) for text in re.findall(r"[-+]?\d+\.?\d*", said.splitlines()[-1])]


@pytest.mark.parametrize(("line", "sign"), [("circle 50cm", ""), ("circle 50cm --right", "-")])
def test_a_circle_of_50_cm_is_as_wide_as_was_meant(tank: Rig, line: str, sign: str) -> None:
    result = ask(tank, line)
    assert (result.returncode, result.stderr) == (0, "")
    assert f"says /tank/cmd_vel Twist '{{linear: {{x: 0.5}}, angular: {{z: {sign}1}}}}'" in result.stdout
    radius, meant, *_ = numbers(result.stdout)
    assert (radius, meant) == (pytest.approx(0.5, abs=0.02), 0.5)


@pytest.mark.parametrize("robot", ["car", "tank"])
def test_a_square_ends_where_it_began(request: pytest.FixtureRequest, robot: str) -> None:
    result = ask(request.getfixturevalue(robot), "square 40cm")
    assert (result.returncode, result.stderr) == (0, "")
    assert ("turns on the spot" if robot == "tank" else "arcs of 0.74 m") in result.stdout
    off, turned, *_ = numbers(result.stdout)
    assert (off, turned) == (pytest.approx(0.0, abs=0.08), pytest.approx(360.0, abs=12.0))


@pytest.mark.parametrize(
    ("robot", "place"),
    [("tank", "-20cm -0.1"), ("car", "1m 50cm --speed 1m/s"), ("car", "-1 -50cm --speed 1m/s --within 20cm")],
)
def test_a_place_is_driven_to(request: pytest.FixtureRequest, robot: str, place: str) -> None:
    result = ask(request.getfixturevalue(robot), f"goto {place}")
    assert (result.returncode, result.stderr) == (0, "")
    *_, x, y, off, way, _ = [float(n) for n in re.findall(r"-?\d+\.\d+", result.stdout)]
    meant_x, meant_y = (quantity(text, "length") for text in place.split()[:2])
    assert (x, y) == (pytest.approx(meant_x, abs=0.25), pytest.approx(meant_y, abs=0.25))
    assert off <= 0.25
    assert way > 0.1
    again = ask(request.getfixturevalue(robot), f"goto {place}")
    assert (again.returncode, again.stderr) == (0, "")
    assert f"{robot if robot == 'tank' else 'bench'} is there already, " in again.stdout
    assert again.stdout.count("\n") == 1


@pytest.mark.parametrize(
    ("line", "way", "turned"),
    [
        ("drive 20cm/s 30deg/s --for 1s", 0.2, 30.0),
        ("drive -0.2m/s --for 1s", 0.2, 0.0),
        ("drive -30deg/s --for 1s", 0.0, -30.0),
        ("drive 0.2 0.5 --for 1s", 0.2, 28.6),
    ],
)
def test_a_motion_is_measured(tank: Rig, line: str, way: float, turned: float) -> None:
    result = ask(tank, line)
    assert (result.returncode, result.stderr) == (0, "")
    went, angle, *_ = numbers(result.stdout)
    assert (went, angle) == (pytest.approx(way, abs=0.06), pytest.approx(turned, abs=9.0))


@pytest.mark.parametrize(
    ("line", "code", "words"),
    [
        ("circle 50cm", 1, "expected a radius of 60cm or more, as bench steers no tighter, found 50cm"),
        ("circle 60 cm", 2, "cm stands alone; write number and unit together, such as 50cm"),
        ("circle fifty", 2, "expected a length such as 50cm, found 'fifty'"),
        ("circle 0", 2, "expected more than nothing, found 0"),
        ("goto 1m 1m --speed fast", 2, "expected a speed such as 0.2m/s, found 'fast'"),
        ("goto 1m", 2, "the following arguments are required: Y"),
        ("goto here 1m", 2, "argument X: expected a length such as 50cm, found 'here'"),
        ("circle 1m --laps none", 2, "expected a number of laps such as 2 or 0.5, found none"),
        ("square -1m", 2, "expected more than nothing, found -1m"),
        ("drive 0.2m", 1, "expected a speed such as 0.2m/s, found '0.2m', which is a length"),
        (
            "drive 1m/s 2m/s",
            1,
            "expected a turning speed such as 30deg/s, found '2m/s', which is a speed",
        ),
        ("drive 1 2 3", 1, "a speed and a turning speed say it all, found '3' as well"),
        ("drive 1m/s --robot nobody", 1, "robot nobody does not answer; is its actuator on?"),
    ],
)
def test_what_cannot_be_driven_is_said_in_a_sentence(car: Rig, line: str, code: int, words: str) -> None:
    result = ask(car, line)
    assert result.returncode == code
    assert words in result.stderr.splitlines()[-1]


def started(rig: Rig, line: str) -> Process:
    """Begin a course, and wait until the robot moves."""
    motion = rig.join(*line.split())
    until(lambda: (rig.ticks[1] or 0) > NEUTRAL[1] + 12, "motion")
    return motion


def is_over(rig: Rig, motion: Process, words: str) -> None:
    assert motion.ends() == 1
    assert words in motion.lines[-1]
    assert any("m were meant" in line for line in motion.lines), "what it came to so far"
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_a_stop_ends_a_course_for_good(car: Rig) -> None:
    circle = started(car, "circle 2m")
    assert ask(car, "stop --why cat").returncode == 0
    is_over(car, circle, "zteleop circle: not driven to its end: ")
    assert "stop" in circle.lines[-1]
    assert ask(car, "stop --release").returncode == 0
    assert car.ticks == NEUTRAL


def test_whoever_drives_with_keys_takes_over_from_a_course(car: Rig) -> None:
    circle = started(car, "circle 2m")
    keys = car.keyboard("--drive", "hold", tells_releases=True)
    keys.shows("program")
    keys.type("\x1b[1;1:1A")
    assert circle.ends() == 1
    assert "keyboard" in circle.lines[-1]
    keys.type("q")


def test_a_program_drives_instead_of_whoever_plans(car: Rig) -> None:
    planner = started(car, "goto 99m 0")
    program = started(car, "drive 0.5m/s")
    assert planner.ends() == 1
    assert "program" in planner.lines[-1]
    program.signal(signal.SIGINT)
    program.ends()


def test_ctrl_c_brings_it_to_rest_and_says_how_far_it_came(car: Rig) -> None:
    drive = started(car, "drive 0.5m/s")
    drive.signal(signal.SIGINT)
    assert drive.ends() == 130
    until(lambda: car.ticks == NEUTRAL, "rest")
    assert drive.lines[-1].startswith("went 0.")


def test_a_course_needs_somebody_who_says_where_the_robot_is(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("blind"), "blind") as rig:
        rig.actuator()
        result = ask(rig, "circle 1m")
        assert result.returncode == 1
        assert (
            "nobody says where blind is, on /blind/odom; zteleop sim does of a simulated robot"
            in result.stderr
        )
        result = ask(rig, "drive 0.5m/s --for 200ms")
        assert (result.returncode, result.stderr) == (0, "")
        assert "nobody says where blind is: what it did was not measured" in result.stdout


def test_a_robot_without_odometry_is_driven_by_what_it_is_told(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("real"), "real") as rig:
        rig.actuator()
        odometry = rig.join("odometry")
        odometry.says("says where real should be, by what its wheels are told: an estimate, which drifts")
        result = ask(rig, "circle 1m --laps 0.3 --speed 1m/s")
        assert (result.returncode, result.stderr) == (0, "")
        assert numbers(result.stdout)[0] == pytest.approx(1.0, abs=0.1)
        second = ask(rig, "odometry")
        assert second.returncode == 1
        assert "odometry on " in second.stderr
        assert second.stderr.endswith("says where real is already; end that, or say --robot NAME\n")
        assert "says where real is already" in ask(rig, "sim").stderr
        odometry.signal(signal.SIGINT)
        assert odometry.ends() == 130


def test_a_course_ends_when_nobody_says_any_more_where_the_robot_is(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    with Rig(tmp_path_factory.mktemp("lost"), "lost") as rig:
        rig.actuator()
        sim = rig.join("sim")
        sim.says("is heard")
        circle = started(rig, "circle 2m")
        sim.signal(signal.SIGKILL)
        assert circle.ends() == 1
        assert circle.lines[-1].endswith("not driven to its end: nobody says any more where lost is")
        until(lambda: rig.ticks == NEUTRAL, "rest")
