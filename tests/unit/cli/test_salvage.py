from pathlib import Path

import pytest

from zteleop.bus.settings import BusSettings
from zteleop.cli._salvage import salvage
from zteleop.config import Config
from zteleop.control.stick import Speeds

BUS = '[bus]\nconnect = ["tcp/pi:7447"]\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "config.toml"


def test_a_file_that_is_right_is_read_whole(file: Path) -> None:
    file.write_text(f'robot = "archangel"\n{BUS}')
    assert salvage(file) == (Config(robot="archangel", bus=BusSettings(connect=["tcp/pi:7447"])), "")


@pytest.mark.parametrize(
    "text",
    [
        f'robt = "michael"\nrobot = "archangel"\n{BUS}',
        f'robot = "archangel"\n{BUS}[drive.mixer]\nkind = "tank"\n',
        f'robot = "archangel"\n{BUS}mode = "pear"\n',
        f'robot = "archangel"\n[drive\nx = \n{BUS}',
        f'robot = "archangel"\nspeeds = \n{BUS}multicast = yes\n',
        f'robot = "archangel"\n{BUS}\n[bus]\nmulticast = "no"\n',
        f'robot = "archangel"\n[drivers.pca9685]\nadress = 0x41\n{BUS}',
    ],
)
def test_what_is_wrong_is_said_and_costs_nothing_else(file: Path, text: str) -> None:
    file.write_text(text)
    settings, wrong = salvage(file)
    assert (settings.robot, settings.bus.connect) == ("archangel", ["tcp/pi:7447"])
    assert wrong.startswith(f"{file}:")


@pytest.mark.parametrize("content", [b"\x00\xff\xfe", b"[" * 10_000, b"a" * 2**20, b"\n[bus]\nconnect = 7\n"])
def test_of_a_file_that_is_none_everything_is_built_in(file: Path, content: bytes) -> None:
    file.write_bytes(content)
    settings, wrong = salvage(file)
    assert settings == Config()
    assert wrong


def test_a_file_that_is_not_there_is_said(file: Path) -> None:
    assert salvage(file) == (Config(), f"cannot read {file}: No such file or directory")


def test_a_table_of_which_a_part_is_wrong_keeps_the_rest(file: Path) -> None:
    file.write_text("[speeds]\nforward = 0.7\nturn = true\nforwards = 3\n[steps]\nsteering_step_ticks = 9\n")
    settings, _ = salvage(file)
    assert settings.steps.steering_step_ticks == 9
    assert settings.speeds == Speeds(forward=0.7)


SERVOS = """
[drive.servos.throttle]
channel = 0
min_us = 900.0
neutral_us = 1400.0
max_us = 2000.0
[drive.servos.steering]
channel = 1
min_us = 1300.0
neutral_us = 1485.0
max_us = 1700.0
"""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("channel = 0", "channel = 99"),
        ("max_us = 2000.0", "max_us = 9999"),
        ("max_us = 2000.0", 'max_us = "far"'),
        ("min_us = 900.0", "mn_us = 900.0"),
        ("min_us = 900.0\n", "min_us = 900.0\nslew = 3\n"),
    ],
)
def test_one_bad_value_of_a_servo_costs_neither_its_neutral_nor_the_other_servo(
    file: Path, right: str, wrong: str
) -> None:
    file.write_text(SERVOS.replace(right, wrong, 1))
    settings, said = salvage(file)
    assert said
    servos = settings.drive.servos
    assert (servos["throttle"].neutral_us, servos["steering"].neutral_us) == (1400.0, 1485.0)


def test_a_servo_whose_pulses_cannot_be_is_as_built_in_and_the_other_stays(file: Path) -> None:
    file.write_text(SERVOS.replace("max_us = 1700.0", "max_us = 1400.0"))
    servos = salvage(file)[0].drive.servos
    assert servos["steering"] == Config().drive.servos["steering"]
    assert servos["throttle"].neutral_us == 1400.0
