"""`zteleop calibrate`: somebody at a terminal who watches the wheels of a car that nobody knows."""

import re
import shlex
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest
from rig import NEUTRAL, Process, Rig, hear, until

from zteleop.control.settings import DONKEYCAR
from zteleop.messages import Odometry
from zteleop.sim.unknown import unknown

TICK = 4.08
PAGE = (Path(__file__).parents[2] / "docs/car.md").read_text()
TYPED = [shlex.split(line) for line in re.findall(r"^    zteleop (.+)$", PAGE, re.MULTILINE)]
INIT, SIM, CALIBRATE, ACTUATOR, CIRCLE, BACKWARD = TYPED[:6]
SEED = int(SIM[-1])
REALLY = unknown(DONKEYCAR, SEED)
TURNS = re.compile(r"and turn at 0\.(0[1-9]|[1-9])")
UP, DOWN, RIGHT, LEFT = ("\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D")
ENTER = "\r"
STEERING, THROTTLE = 0, 1
KEYS = {STEERING: (LEFT, RIGHT), THROTTLE: (UP, DOWN)}
"""that raise, and lower, the ticks of each"""


@pytest.fixture
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("calibrate")) as bench:
        yield bench


def where(rig: Rig) -> list[str]:
    """Return the options of whoever starts the robot."""
    return ["--robot", rig.robot, "--no-multicast-scouting", "--listen", rig.endpoint]


class Sitting:
    """Somebody who sits before the questions: he presses keys until the chip is where he wants it."""

    def __init__(self, rig: Rig, *command: str) -> None:
        self.rig = rig
        self.screen = rig.terminal(*(command or ("calibrate",)), *where(rig), columns=100, rows=30)
        self.screen.shows("1 of 7", " idle")
        self.neutral = [*NEUTRAL]

    def turn(self, channel: int, ticks: int) -> None:
        """Turn to these ticks: a robot puts out what is asked for, or says why not."""
        up, down = KEYS[channel]
        moved = ticks - self.neutral[channel]
        self.screen.type((up if moved > 0 else down) * abs(moved))
        self.shows(channel, ticks)

    def shows(self, channel: int, ticks: int) -> None:
        until(lambda: self.rig.ticks[channel] == ticks, f"{ticks} at the chip, not {self.rig.ticks}")
        self.screen.shows("throttle {1}, steering {0}".format(*self.rig.ticks))

    def reverse(self, ticks: int, below: int, looks: Callable[[], object] = lambda: None) -> None:
        """Do what the screen says of an ESC that brakes first: below neutral once, space, and then again.

        Each for as long as it takes the simulator to look at the chip: a real ESC sees every pulse.
        """
        self.turn(THROTTLE, below)
        looks()
        self.screen.type(" ")
        self.shows(THROTTLE, self.neutral[THROTTLE])
        looks()
        self.turn(THROTTLE, ticks)

    def answers(self, number: int) -> None:
        self.screen.type(ENTER)
        self.screen.shows(f"{number + 1} of 7", " idle")


def ticks_of(pulse_us: float) -> int:
    return round(pulse_us / TICK)


def test_whoever_follows_the_page_drives_a_circle_with_a_car_that_nobody_knew(rig: Rig) -> None:
    """The page's commands in their order; the answers are what somebody sees who watches the wheels."""
    throttle, steering = REALLY.servos["throttle"], REALLY.servos["steering"]
    (rig.folder / "config.toml").unlink()
    assert rig.result(*INIT).returncode == 0
    rig.set(f'drivers.simulated.path = "{rig.chip}"')
    sim = rig.join(*SIM)
    sitting = Sitting(rig, *CALIBRATE)
    odoms = rig.node("watcher").subscription("odom", Odometry)

    def looks() -> None:
        """Wait until the simulator has looked at the chip: it says so often where it is."""
        list(odoms.take())
        for _ in range(3):
            hear(odoms, lambda seen: True, "the simulator")

    begins = REALLY.settings.esc_deadband_us
    forward = int((throttle.neutral_us + begins) / TICK) + 1
    backward = -int((begins - throttle.neutral_us) // TICK) - 1
    sitting.turn(THROTTLE, forward - 1)
    sitting.screen.type(UP)
    until(lambda: TURNS.search(sim.text), "the wheels turn")  # one tick less did not turn them
    sitting.answers(1)
    sitting.reverse(backward, backward - 10, looks)
    sim.says("and turn at -0.")
    sitting.screen.type(ENTER)
    sitting.screen.shows("the robot starts anew")
    sitting.screen.type("zzz\r")  # between two screens: neither shows nor counts
    sitting.screen.shows("3 of 7", "forward starts", " idle")
    assert b"zzz" not in sitting.screen.output
    middle = (forward + backward) / 2
    until(lambda: abs((rig.ticks[THROTTLE] or 0) - middle) <= 1, "the motor's own neutral")
    sitting.neutral[THROTTLE] = rig.ticks[THROTTLE] or 0
    sitting.turn(STEERING, ticks_of(steering.neutral_us))
    sitting.answers(3)
    sitting.turn(STEERING, ticks_of(steering.max_us))
    sim.says("deg to the left")
    sitting.answers(4)
    sitting.turn(STEERING, ticks_of(steering.min_us))
    sim.says("deg to the right")
    sitting.answers(5)
    sitting.turn(THROTTLE, ticks_of(throttle.max_us))
    sitting.answers(6)
    sitting.reverse(ticks_of(throttle.min_us), backward - 10, looks)
    sitting.screen.type(ENTER)
    assert sitting.screen.ends() == 0
    assert "config.toml is written" in sitting.screen.output.decode()
    assert "; tapped twice to reverse" in sitting.screen.output.decode()
    found = msgspec.toml.decode((rig.folder / "config.toml").read_bytes())["drive"]["servos"]
    for name, servo in REALLY.servos.items():
        for field in ("min_us", "neutral_us", "max_us"):
            assert abs(found[name][field] - getattr(servo, field)) <= 2 * TICK, (name, field)
    rig.run(*ACTUATOR, *where(rig)).says("obeys")
    circle = rig.result(*CIRCLE, *rig.bus_options())
    radius = re.search(r"a radius of (\d\.\d\d) m", circle.stdout)
    assert radius, circle.stderr
    assert float(radius[1]) == pytest.approx(1.0, abs=0.05)
    assert (REALLY.settings.reverse, found["throttle"]["reverse"]) == ("double_tap", "double_tap")
    back = rig.result(*BACKWARD, *rig.bus_options())
    way = re.search(r"went (\d\.\d\d) m backwards", back.stdout)
    assert way, back
    assert float(way[1]) > 0.4


def test_a_car_is_trimmed_while_it_drives_until_it_goes_straight(rig: Rig) -> None:
    screen = rig.terminal("calibrate", "--trim", *where(rig), columns=100, rows=30)
    screen.shows("1 of 1", "up and down drive, left and right turn the steering", " idle")
    screen.type(UP)
    until(lambda: (rig.ticks[THROTTLE] or 0) > NEUTRAL[THROTTLE] + 3, "it drives, beyond the dead zone")
    screen.type(RIGHT * 3)
    until(lambda: rig.ticks[STEERING] == NEUTRAL[STEERING] - 3, "three ticks to the right")
    shown = screen.shows("allowed", f"steering {NEUTRAL[STEERING] - 3}")
    assert re.search(r"allowed +\+0\.0[5-9]", shown), "as fast as ever, not as on a bench"
    screen.type(ENTER)
    assert screen.ends() == 0
    assert rig.ticks == tuple(NEUTRAL), "it stands"
    servos = msgspec.toml.decode((rig.folder / "config.toml").read_bytes())["drive"]["servos"]
    assert servos["steering"]["neutral_us"] == pytest.approx((NEUTRAL[STEERING] - 3) * TICK, abs=0.1)
    for name, field in (("steering", "min_us"), ("steering", "max_us"), ("throttle", "neutral_us")):
        assert servos[name][field] == pytest.approx(getattr(DONKEYCAR[name], field), abs=0.1)


def test_what_is_not_finished_is_not_written(rig: Rig) -> None:
    before = (rig.folder / "config.toml").read_text()
    sitting = Sitting(rig)
    screen = sitting.screen
    sitting.turn(THROTTLE, 380)
    sitting.answers(1)
    screen.type("q")
    assert screen.ends() == 1
    words = "left before the end: config.toml is as it was, and its neutral is written"
    assert words in screen.output.decode()
    assert (rig.folder / "config.toml").read_text() == before
    assert not (rig.folder / "config.toml.bak").exists()
    assert rig.ticks == NEUTRAL


def test_a_neutral_that_is_not_written_does_not_stay_on_the_chip(rig: Rig) -> None:
    """Both answers lie below: what was found would turn the wheels of this car for ever."""
    sitting = Sitting(rig)
    sitting.turn(THROTTLE, 364)
    sitting.answers(1)
    sitting.turn(THROTTLE, 360)
    sitting.screen.type(ENTER)
    sitting.screen.shows("3 of 7", " idle")
    until(lambda: rig.ticks[THROTTLE] == 362, "what was found is in use")
    sitting.screen.type("q")
    assert sitting.screen.ends() == 1
    assert rig.ticks == NEUTRAL


def test_only_what_is_asked_for_turns(rig: Rig) -> None:
    screen = Sitting(rig).screen
    screen.type(LEFT + RIGHT + LEFT + UP)
    until(lambda: rig.ticks == (NEUTRAL[0], NEUTRAL[1] + 1), "one tick of throttle")
    screen.type("\x1b[5~")
    until(lambda: rig.ticks == (NEUTRAL[0], NEUTRAL[1] + 11), "ten more")
    screen.shows("throttle 381, steering 375")
    screen.type(" ")
    screen.shows("throttle 370, steering 375")
    screen.type(ENTER)
    screen.shows("1 of 7", "it is at neutral, 370: turn it, and k keeps it there")
    screen.type("s")
    screen.shows("2 of 7")
    screen.type("b")
    screen.shows("1 of 7")


def test_a_stop_from_anywhere_stops_it_and_what_is_stopped_is_no_answer(rig: Rig) -> None:
    screen = Sitting(rig).screen
    screen.type(UP * 5)
    until(lambda: rig.ticks[THROTTLE] == NEUTRAL[THROTTLE] + 5, "five ticks")
    assert rig.result("stop", *rig.bus_options()).returncode == 0
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    screen.shows("stopped")
    screen.type(UP * 3)
    screen.type(ENTER)
    screen.shows("1 of 7", "stopped")
    assert rig.ticks == NEUTRAL


def test_a_program_that_was_left_running_turns_no_motor(rig: Rig) -> None:
    """Its twist would be full throttle of a servo that may go as far as any."""
    screen = Sitting(rig).screen
    program = rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 3.0}}", "-r", "10")
    screen.shows("program")
    program.says("publishing #20")
    assert abs((rig.ticks[THROTTLE] or 0) - NEUTRAL[THROTTLE]) <= 1
    program.close()


def test_a_calibration_that_is_killed_leaves_neutral_and_nobody_behind(rig: Rig) -> None:
    screen = Sitting(rig).screen
    screen.type(UP * 5)
    until(lambda: rig.ticks[THROTTLE] == NEUTRAL[THROTTLE] + 5, "five ticks")
    screen.process.kill()
    until(lambda: rig.ticks == NEUTRAL, "neutral")


def test_a_chip_that_is_driven_already_is_said(rig: Rig) -> None:
    rig.actuator()
    screen = rig.terminal("calibrate", *rig.bus_options())
    assert screen.ends() == 1
    assert "is driven by process" in screen.output.decode()


def refused(rig: Rig, *words: str) -> str:
    result: subprocess.CompletedProcess[str] = rig.result("calibrate", *words)
    assert result.returncode == 1, result.stdout
    assert "Traceback" not in result.stderr
    return " ".join(result.stderr.split())


def test_without_a_terminal_it_says_what_it_needs(rig: Rig) -> None:
    assert "terminal" in refused(rig, *where(rig))


def test_a_tank_is_told_how_it_is_done(rig: Rig) -> None:
    rig.set(
        '[drive.mixer]\nkind = "differential"\n[drive.servos]\nleft = {channel = 0}\nright = {channel = 1}\n'
    )
    assert "calibrate knows cars" in refused(rig)


DONKEY = """
STEERING_LEFT_PWM = 440
STEERING_RIGHT_PWM = 300
THROTTLE_STOPPED_PWM = 372
THROTTLE_RANGE = 100
"""


def test_a_donkeycars_calibration_is_taken_over_and_given_back(rig: Rig) -> None:
    (rig.folder / "mycar").mkdir()
    (rig.folder / "mycar/config.py").write_text(DONKEY)
    (rig.folder / "mycar/myconfig.py").write_text("STEERING_LEFT_PWM = 450\n")
    before = (rig.folder / "config.toml").read_text()
    for take in (("mycar/config.py",), ("mycar",)):
        shown = rig.result("calibrate", "--from-donkeycar", *take, "--dry-run")
        assert "+min_us = 1224.0" in shown.stdout, shown.stderr
    assert (rig.folder / "config.toml").read_text() == before
    taken = rig.result("calibrate", "--from-donkeycar", "mycar")
    assert "steering on channel 1: 300 375 450 ticks, before 290 375 460" in taken.stdout, taken.stderr
    assert "throttle on channel 0: 272 372 472 ticks" in taken.stdout
    assert (rig.folder / "config.toml.bak").read_text() == before
    assert rig.result("check").returncode == 0
    given = rig.result("calibrate", "--to-donkeycar", "back.py")
    assert given.returncode == 0, given.stderr
    assert '"STEERING_LEFT_PWM": 450' in (rig.folder / "back.py").read_text()
    assert "back.py is there already" in refused(rig, "--to-donkeycar", "back.py")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "cannot read car.py: No such file or directory"),
        (
            DONKEY + "STEERING_LEFT_PWM = min(1, 2)\n",
            "car.py:6: STEERING_LEFT_PWM: expected a plain value, found code",
        ),
        (
            "DRIVE_TRAIN_TYPE = 'VESC'",
            "car.py:1: DRIVE_TRAIN_TYPE: expected PWM_STEERING_THROTTLE or I2C_SERVO",
        ),
        (DONKEY.replace("440", "300"), "car.py: pulses 300 300 300 ticks: neutral_us must lie between"),
        (DONKEY.replace("440", "4000"), "steering.max_us"),
    ],
)
def test_a_donkeycar_that_cannot_be_is_refused_and_nothing_is_written(
    rig: Rig, text: str | None, words: str
) -> None:
    if text:
        (rig.folder / "car.py").write_text(text)
    before = (rig.folder / "config.toml").read_text()
    assert words in refused(rig, "--from-donkeycar", "car.py")
    assert (rig.folder / "config.toml").read_text() == before


def test_a_config_that_is_wrong_already_is_said_and_stays(rig: Rig) -> None:
    rig.set("robt = 3")
    assert "did you mean robot?" in refused(rig, "--to-donkeycar", "x.py")


def test_the_sim_says_what_is_seen_of_the_wheels(rig: Rig) -> None:
    rig.actuator()
    sim: Process = rig.join("sim", "car", "--unknown")
    sim.says("its wheels point ")
