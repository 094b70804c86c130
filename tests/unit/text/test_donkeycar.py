"""A Donkeycar's own settings, read and never run."""

from pathlib import Path

import pytest

from zteleop.errors import ConfigError
from zteleop.text.donkeycar import Donkeycar, Output, read, written

NESTED = """
import os
CAR_PATH = os.path.dirname(os.path.realpath(__file__))
DRIVE_LOOP_HZ = 20
CAMERA_FRAMERATE = DRIVE_LOOP_HZ
STEERING_LEFT_PWM = 1  # of another drive train
DRIVE_TRAIN_TYPE = "PWM_STEERING_THROTTLE"
PWM_STEERING_THROTTLE = {
    "PWM_STEERING_PIN": "PCA9685.1:40.1",
    "PWM_STEERING_SCALE": 1.0,
    "PWM_STEERING_INVERTED": False,
    "PWM_THROTTLE_PIN": "PCA9685.1:40.0",
    "PWM_THROTTLE_SCALE": 1.0,
    "PWM_THROTTLE_INVERTED": False,
    "STEERING_LEFT_PWM": 470,
    "STEERING_RIGHT_PWM": 300,
    "THROTTLE_FORWARD_PWM": 510,
    "THROTTLE_STOPPED_PWM": 380,
    "THROTTLE_REVERSE_PWM": 230,
}
"""
FLAT = """
STEERING_CHANNEL = 2
THROTTLE_CHANNEL = 3
STEERING_LEFT_PWM = 460
STEERING_RIGHT_PWM = 290
THROTTLE_FORWARD_PWM = 500
THROTTLE_STOPPED_PWM = 370
THROTTLE_REVERSE_PWM = 220
PCA9685_I2C_ADDR = 0x41
PCA9685_I2C_BUSNUM = None
"""
COURSE = """
STEERING_LEFT_PWM = 460
STEERING_RIGHT_PWM = 290
THROTTLE_STOPPED_PWM = 370
THROTTLE_RANGE = 50
"""


def car(*texts: str) -> Donkeycar:
    return read((f"file{number}.py", text) for number, text in enumerate(texts))


def test_the_table_of_a_new_one_is_read() -> None:
    assert car(NESTED) == Donkeycar(Output(1, 300, 385, 470), Output(0, 230, 380, 510), 1, 0x40)


def test_the_names_of_an_older_one_are_read() -> None:
    assert car(FLAT) == Donkeycar(Output(2, 290, 375, 460), Output(3, 220, 370, 500), None, 0x41)


def test_an_older_drive_train_does_not_read_the_table_of_the_new_one() -> None:
    found = car(NESTED + FLAT + 'DRIVE_TRAIN_TYPE = "I2C_SERVO"\n')
    assert (found.steering.most, found.throttle.channel) == (460, 3)


def test_the_range_of_a_course_stands_for_both_ends_and_its_channels_are_not_guessed() -> None:
    assert car(COURSE) == Donkeycar(Output(None, 290, 375, 460), Output(None, 320, 370, 420))


def test_what_myconfig_says_goes_before_config() -> None:
    assert car(FLAT, "STEERING_LEFT_PWM = 440\n").steering == Output(2, 290, 365, 440)


def test_a_scale_is_what_reaches_the_wire() -> None:
    scaled = NESTED.replace('"PWM_STEERING_SCALE": 1.0', '"PWM_STEERING_SCALE": 0.5')
    assert car(scaled).steering == Output(1, 150, 192.5, 235)


def test_what_is_written_is_read_again() -> None:
    found = car(NESTED)
    assert car(written(found)) == found


@pytest.mark.parametrize(
    "code",
    [
        "STEERING_LEFT_PWM = 400 + 60",
        "STEERING_LEFT_PWM = int('460')",
        "if True:\n    STEERING_LEFT_PWM = 460",
        "STEERING_LEFT_PWM += 1",
        "from numbers import left as STEERING_LEFT_PWM",
        "for STEERING_LEFT_PWM in (1, 2):\n    pass",
        "del STEERING_LEFT_PWM",
    ],
)
def test_what_would_have_to_be_run_is_refused_and_where_it_stands(code: str) -> None:
    with pytest.raises(ConfigError, match=r"file1\.py:1: STEERING_LEFT_PWM: .*found code; .*never runs"):
        car(FLAT, code)


@pytest.mark.parametrize(
    "code",
    ['PWM_STEERING_THROTTLE["STEERING_LEFT_PWM"] = 480', "PWM_STEERING_THROTTLE.update(x=1)"],
)
def test_a_table_that_is_changed_by_code_is_refused(code: str) -> None:
    with pytest.raises(ConfigError, match=r"file1\.py:1: PWM_STEERING_THROTTLE: .*found code"):
        car(NESTED, code)


def test_code_that_is_none_of_its_business_is_neither_run_nor_refused(tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    assert car(FLAT + f"open({str(mark)!r}, 'w')\n").steering.channel == 2
    assert not mark.exists()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = (", "file0.py:1: expected a Donkeycar config in Python"),
        ("\0", "expected a Donkeycar config in Python"),
        ("", "file0.py: expected STEERING_LEFT_PWM, found none"),
        (FLAT.replace("460", "'460'"), "file0.py:4: STEERING_LEFT_PWM: expected a number between 1 and 4095"),
        (FLAT.replace("460", "True"), "expected a number between 1 and 4095, found True"),
        (FLAT.replace("460", "5000"), "expected a number between 1 and 4095, found 5000"),
        (FLAT.replace("460", "1e400"), "expected a number between 1 and 4095, found inf"),
        (FLAT.replace("= 2", "= 16"), "STEERING_CHANNEL: expected a number between 0 and 15, found 16"),
        (
            FLAT.replace("STOPPED", "STOPED"),
            "expected THROTTLE_STOPPED_PWM, found none; did you mean THROTTLE_STOPED_PWM",
        ),
        (
            NESTED.replace('E = "PWM_STEERING_THROTTLE"', 'E = "VESC"'),
            "DRIVE_TRAIN_TYPE: expected PWM_STEERING_THROTTLE or I2C_SERVO",
        ),
        (NESTED.replace('INVERTED": False', 'INVERTED": True'), "zteleop makes no inverted pulses"),
        (
            NESTED.replace("PCA9685.1:40.1", "RPI_GPIO.BOARD.33"),
            "PWM_STEERING_PIN: expected a pin of a PCA9685",
        ),
        (
            NESTED.replace("PCA9685.1:40.1", "PCA9685.1:40.16"),
            "PWM_STEERING_PIN: expected a pin of a PCA9685",
        ),
        (NESTED.replace("PCA9685.1:40.1", "PCA9685.1:41.1"), "expected both pins on one chip, found two"),
        ("PWM_STEERING_THROTTLE = 3", "expected a table"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(text: str, words: str) -> None:
    with pytest.raises(ConfigError) as caught:
        car(text)
    assert words in str(caught.value)


def test_two_servos_on_one_channel_are_refused_by_the_names_of_the_files() -> None:
    with pytest.raises(ConfigError, match=r"^file0\.py and file1\.py: steering and throttle are both on"):
        car(FLAT, "STEERING_CHANNEL = 3\n")
