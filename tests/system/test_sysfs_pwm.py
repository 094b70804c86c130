"""A robot on Linux's own PWM files: the same processes, and the same neutral, at other pins."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from rig import Rig, until

CONFIG = """
driver = "sysfs_pwm"
[drivers.sysfs_pwm]
folder = "{folder}"
arming = 0.0
"""
THROTTLE, STEERING = 0, 1
NEUTRAL = {THROTTLE: 1509.6, STEERING: 1530.0}


class Pins:
    """Files as the kernel shows them for a chip with two channels that are exported already."""

    def __init__(self, folder: Path) -> None:
        self._chip = folder / "pwmchip0"
        for channel in (0, 1):
            at = self._chip / f"pwm{channel}"
            at.mkdir(parents=True)
            for name, text in (("period", "0"), ("duty_cycle", "0"), ("enable", "0"), ("polarity", "normal")):
                (at / name).write_text(text)
        (self._chip / "export").write_text("")

    def width_us(self, channel: int) -> float | None:
        at = self._chip / f"pwm{channel}"
        if (at / "enable").read_text() != "1":
            return None
        return int((at / "duty_cycle").read_text() or 0) / 1000  # empty while it is being written

    def rest(self) -> bool:
        return all(self.width_us(channel) == width for channel, width in NEUTRAL.items())


@pytest.fixture
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("sysfs")) as bench:
        yield bench


@pytest.fixture
def pins(rig: Rig) -> Pins:
    folder = rig.folder / "pwm"
    (rig.folder / "config.toml").write_text(CONFIG.format(folder=folder))
    return Pins(folder)


def test_it_is_driven_and_whatever_dies_it_rests(rig: Rig, pins: Pins) -> None:
    robot = rig.actuator()
    assert pins.rest()
    keys = rig.keyboard("--drive", "step")
    keys.shows(" idle")
    keys.type("\x1b[A\x1b[A\x1b[D")
    until(lambda: (pins.width_us(THROTTLE) or 0) > 1509.6, "throttle")
    until(lambda: (pins.width_us(STEERING) or 0) > 1530.0, "steering to the left")
    child = robot.child
    assert child
    os.kill(child, signal.SIGKILL)
    until(pins.rest, "neutral")
    keys.type("q")
    assert keys.ends() == 0
    robot.close()


def test_neutral_is_written_with_nothing_else_running(rig: Rig, pins: Pins) -> None:
    result = rig.result("neutral", "--robot", rig.robot)
    assert result.returncode == 0, result.stderr
    assert pins.rest()


def test_a_chip_that_is_not_there_is_one_sentence(rig: Rig) -> None:
    (rig.folder / "config.toml").write_text(CONFIG.format(folder=rig.folder / "nowhere"))
    result = rig.result("actuator", "--robot", rig.robot)
    assert result.returncode == 1
    assert "there is no such PWM chip; set chip to one of those there" in " ".join(result.stderr.split())
