"""The Donkeycar nodes' `PWMController`, in a program of its own, at the chip."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from rig import NEUTRAL, Process, Rig, until


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("pwm")) as bench:
        configure(bench)
        bench.actuator()
        yield bench


@pytest.fixture(scope="module", autouse=True)
def lost(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A program beside no robot, begun early because it waits for one, if only for a second here."""
    with Rig(tmp_path_factory.mktemp("lost")) as bench:
        configure(bench)
        unheard = "import zteleop.compat.pwm_controller as it\nit.HEARD_WITHIN = 0\nPWMController(1)"
        yield program(bench, unheard)


def configure(rig: Rig) -> None:
    """Write the config file that leads a program in this folder to the robot."""
    (rig.folder / "config.toml").write_text(f"""
robot = "{rig.robot}"
[drivers.simulated]
path = "{rig.chip}"
[bus]
connect = ["{rig.endpoint}"]
multicast = false
""")


def program(rig: Rig, text: str) -> Process:
    return rig.program(f"import time\nfrom zteleop import PWMController\n{text}")


@contextmanager
def running(rig: Rig, text: str) -> Iterator[Process]:
    """Run a program meanwhile, and give the robot to the next test at rest."""
    controller = program(rig, text)
    yield controller
    controller.close()
    until(lambda: rig.ticks == NEUTRAL, "neutral")


BOTH = """
steering, throttle = PWMController(channel=1), PWMController(0, frequency=60)
steering.set_pwm(300)
while True:
    throttle.set_pwm(380)
    time.sleep(0.05)
"""


def test_one_channel_is_moved_and_the_other_stays(rig: Rig) -> None:
    with running(rig, BOTH):
        until(lambda: rig.ticks == (300, 380), "both pulses")


TURNS = """
PWMController(1).set_pwm(4095)
time.sleep(0.1)
PWMController(1, 50).set_pwm(333)
time.sleep(9)
"""


def test_pulses_are_counted_at_the_frequency_said_up_to_the_limit(rig: Rig) -> None:
    with running(rig, TURNS):
        until(lambda: rig.ticks == (460, 370), "the end of the range")
        until(lambda: rig.ticks == (398, 370), "333 counts of 4.88 us as counts of 4.08 us")


def test_a_program_that_ends_lets_its_process_end(rig: Rig) -> None:
    controller = program(rig, "PWMController(1).set_pwm(400)\nprint('done')")
    assert controller.ends() == 0
    done, lets_go = controller.lines
    assert done == "done"
    assert lets_go.startswith("pwm_controller: warning: what was said on pwm held for ")


def test_a_channel_that_is_none_is_an_error_in_words(rig: Rig) -> None:
    controller = program(rig, "PWMController(7)")
    assert controller.ends() == 1
    words = "zteleop.errors.ConfigError: the robot has no channel 7; throttle is 0, steering is 1"
    assert controller.lines[-1] == words


def test_a_robot_that_does_not_answer_is_an_error_in_words(lost: Process) -> None:
    assert lost.ends() == 1
    words = "zteleop.errors.BusError: robot bench does not answer; start zteleop actuator first"
    assert lost.lines[-1] == words
