import argparse
from pathlib import Path

import pytest

from zteleop import config
from zteleop.cli import calibrate
from zteleop.cli._oscillator import measured
from zteleop.cli._settings_file import SettingsFile
from zteleop.config import Config
from zteleop.errors import ConfigError

REAL = 26e6
"""Hz, where the config says 25 MHz"""


def parsed(text: str) -> Config:
    return config.parse(text.encode(), "config.toml")


BEFORE = parsed('driver = "pca9685"')
MEANT_HZ = 1e6 / (4096 * BEFORE.tick_us)


def test_a_meter_tells_the_oscillator_and_every_pulse_stays_as_long_as_it_was() -> None:
    found = measured(BEFORE, MEANT_HZ * REAL / 25e6)
    assert found["drivers", "pca9685", "osc_hz"] == pytest.approx(REAL, abs=1)
    for name, servo in BEFORE.drive.servos.items():
        for field in ("min_us", "neutral_us", "max_us"):
            ticks = round(getattr(servo, field) / BEFORE.tick_us)
            lasted = ticks * BEFORE.tick_us * 25e6 / REAL
            assert found["drive", "servos", name, field] == pytest.approx(lasted, abs=BEFORE.tick_us / 2)


def test_a_car_that_is_simulated_so_far_keeps_what_was_measured() -> None:
    found = measured(parsed('driver = "simulated"'), MEANT_HZ * REAL / 25e6)
    for driver in ("simulated", "pca9685"):
        assert found["drivers", driver, "osc_hz"] == pytest.approx(REAL, abs=1)


def test_a_meter_that_shows_what_is_meant_changes_nothing() -> None:
    found = measured(BEFORE, MEANT_HZ)
    assert found["drivers", "pca9685", "osc_hz"] == 25e6
    throttle = BEFORE.drive.servos["throttle"]
    assert found["drive", "servos", "throttle", "neutral_us"] == throttle.neutral_us


@pytest.mark.parametrize("hz", [0.001, 30.0, 120.0, -60.0])
def test_what_no_oscillator_makes_is_refused_with_what_to_do(hz: float) -> None:
    with pytest.raises(ConfigError, match=r"where 59\.\d are meant .* measure at a channel with pulses"):
        measured(BEFORE, hz)


def test_pins_have_none() -> None:
    with pytest.raises(ConfigError, match="the oscillator is a PCA9685's, and the driver here is sysfs_pwm"):
        measured(parsed('driver = "sysfs_pwm"'), 60.0)


def test_a_pulse_that_would_be_none_is_said_by_what_reads_the_file(tmp_path: Path) -> None:
    path = tmp_path / "config.toml"
    servos = "throttle = {channel = 0, max_us = 2490}\nsteering = {channel = 1}"
    path.write_text(f'driver = "pca9685"\n[drive.servos]\n{servos}')
    file = SettingsFile(path)
    with pytest.raises(ConfigError, match=r"drive\.servos\.throttle\.max_us: .*2500"):
        file.changed(measured(file.settings, 0.9 * MEANT_HZ))


@pytest.mark.parametrize("hz", ["0", "nan"])
def test_nothing_turns_for_a_meter_that_shows_none(hz: str, tmp_path: Path) -> None:
    parser = argparse.ArgumentParser()
    calibrate.add_arguments(parser)
    with pytest.raises(ConfigError, match="measure at a channel with pulses"):
        calibrate.run(parser.parse_args(["--config", str(tmp_path / "config.toml"), "--meter", hz]))


def test_the_verb_writes_it_and_turns_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "config.toml"
    path.write_text('driver = "pca9685"  # of the car\n')
    parser = argparse.ArgumentParser()
    calibrate.add_arguments(parser)
    assert calibrate.run(parser.parse_args(["--config", str(path), "--meter", "62.3"])) == 0
    assert "# of the car" in path.read_text()
    assert config.load(path).drivers["pca9685"]["osc_hz"] == pytest.approx(25e6 * 62.3 / MEANT_HZ, abs=1)
    assert f"{path} is written" in capsys.readouterr().out
