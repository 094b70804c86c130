import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from zteleop.cli._run import run_verb
from zteleop.drivers import open_driver
from zteleop.drivers.registers import read_duty_ticks
from zteleop.drivers.simulated import open_registers

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def chip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A simulated chip that was left driving."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    path = str(tmp_path / "chip")
    (tmp_path / "config.toml").write_text(f"[drivers.simulated]\npath = {path!r}\n")
    drive(path)
    return path


def drive(path: str) -> None:
    driver = open_driver("simulated", {"path": path})
    driver.start({0: 1509.6, 1: 1530.0})
    driver.write({0: 1700.0, 1: 1600.0})
    driver.close()


def ticks(path: str) -> tuple[int | None, int | None]:
    with open_registers(path) as registers:
        seen = registers.snapshot()
    return read_duty_ticks(seen, 0), read_duty_ticks(seen, 1)


def neutral(*arguments: str) -> int:
    return run_verb("neutral", "neutral", list(arguments))


def test_it_writes_neutral_and_says_what_that_is(chip: str, capsys: Capture) -> None:
    assert ticks(chip) != (370, 375)
    assert neutral("--robot", "archangel") == 0
    assert ticks(chip) == (370, 375)
    assert capsys.readouterr() == (
        f"archangel at rest, in the simulated chip {chip}: "
        "throttle 1510 us = 370 ticks, steering 1530 us = 375 ticks\n",
        "",
    )


def test_a_chip_whose_lock_is_taken_is_at_neutral_and_said_to_be_anothers(chip: str, capsys: Capture) -> None:
    owner = open_driver("simulated", {"path": chip})
    try:
        assert neutral() == 1
    finally:
        owner.close()
    assert ticks(chip) == (370, 375)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("zteleop neutral: neutral was written, but may not last: ")
    assert f"{chip} is driven by process {os.getpid()} already; stop it first" in err


def test_it_is_that_robots_chip_without_a_path(chip: str, tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "config.toml").write_text("robot = 'zoe'\n")
    other, own = (str(tmp_path / "zteleop" / f"{robot}.pca9685") for robot in ("abe", "zoe"))
    drive(other)
    drive(own)
    assert neutral("--robot", "abe") == 0
    assert ticks(other) == (370, 375)
    assert ticks(own) != (370, 375)
    assert neutral() == 0
    assert ticks(own) == (370, 375)


def test_a_chip_that_does_not_answer_is_1_and_a_sentence(chip: str, capsys: Capture, tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text(f"[drivers.simulated]\npath = '{tmp_path}'\n")
    assert neutral() == 1
    assert capsys.readouterr().err.startswith("zteleop neutral: cannot open the simulated chip ")


def test_a_robots_name_leads_to_no_other_file(chip: str, capsys: Capture) -> None:
    assert neutral("--robot", "../../etc/x") == 1
    assert "../../etc/x" in capsys.readouterr().err


def test_its_calibration_is_the_files(chip: str, tmp_path: Path, capsys: Capture) -> None:
    with (tmp_path / "config.toml").open("a") as file:
        file.write("[drive.servos.throttle]\nchannel = 3\nneutral_us = 1500\n")
        file.write("[drive.servos.steering]\nchannel = 1\n")
    assert neutral() == 0
    with open_registers(chip) as registers:
        assert read_duty_ticks(registers.snapshot(), 3) == 368
    assert "throttle 1500 us = 368 ticks" in capsys.readouterr().out


def test_a_robot_that_has_no_chip_moves_nothing_and_is_perhaps_another(
    chip: str, capsys: Capture, tmp_path: Path
) -> None:
    (tmp_path / "config.toml").unlink()
    drive(str(tmp_path / "zteleop" / "archangel.pca9685"))
    assert neutral("--robot", "archangle") == 1
    words = capsys.readouterr().err
    assert words.startswith("zteleop neutral: nothing was written: archangle has no simulated chip at ")
    assert "archangle.pca9685; did you mean archangel?; where it has one elsewhere" in words
    assert not (tmp_path / "zteleop" / "archangle.pca9685").exists()


def test_with_one_bad_value_it_is_the_neutral_of_the_file_and_says_that_more_may_be_wrong(
    chip: str, tmp_path: Path, capsys: Capture
) -> None:
    with (tmp_path / "config.toml").open("a") as file:
        file.write("[drive.servos.throttle]\nchannel = 0\nneutral_us = 1500\nmax_us = 9999\n")
        file.write("[drive.servos.steering]\nchannel = 1\nneutral_us = 1485.1\n")
    assert neutral() == 0
    assert ticks(chip) == (368, 364)
    assert "what of them is built in may not be this robot's" in capsys.readouterr().err


def test_a_driver_that_there_is_not_is_no_simulated_chip(chip: str, tmp_path: Path, capsys: Capture) -> None:
    config = tmp_path / "config.toml"
    config.write_text(f'driver = "pca9658"\n{config.read_text()}')
    assert neutral() == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "nothing was written: which chip is meant by driver = 'pca9658'? did you mean pca9685?" in said
    assert ticks(chip) != (370, 375)
    assert neutral("--driver", "simulated") == 0
    assert ticks(chip) == (370, 375)
