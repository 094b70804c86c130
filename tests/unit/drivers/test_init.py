from pathlib import Path

import pytest

from zteleop.drivers import DRIVERS, open_driver, tick_us
from zteleop.drivers.pca9685 import Pca9685
from zteleop.drivers.simulated import SimulatedSettings
from zteleop.errors import ConfigError


def test_an_unknown_driver_is_refused_with_the_known_names() -> None:
    with pytest.raises(ConfigError, match=r"no driver named 'pca9658'; did you mean pca9685\?"):
        open_driver("pca9658", {})


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"address": 0x20}, r"drivers\.pca9685\.address: expected a whole number from 64 to 127, found 32"),
        ({"adress": 0x40}, r"drivers\.pca9685\.adress: no such setting; did you mean address"),
        (
            {"frequency_hz": "fast"},
            r"drivers\.pca9685\.frequency_hz: expected a number from 24 to 1526, found 'fast'",
        ),
        (
            {"frequency_hz": float("nan")},
            r"frequency_hz: expected a number from 24 to 1526, found nan",
        ),
        ({"frequency_hz": 24, "osc_hz": 30e6}, r"frequency_hz must be within 29\.\.1831, found 24"),
    ],
)
def test_a_wrong_setting_is_named_by_its_path(settings: dict[str, object], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        open_driver("pca9685", settings)


def test_the_simulated_driver_is_the_real_driver_on_a_file(tmp_path: Path) -> None:
    driver = open_driver("simulated", {"path": str(tmp_path / "chip"), "frequency_hz": 50})
    assert isinstance(driver, Pca9685)
    assert driver.tick_us == pytest.approx(4.88)
    driver.close()


def test_settings_may_be_the_struct_that_config_already_made(tmp_path: Path) -> None:
    driver = open_driver("simulated", SimulatedSettings(path=str(tmp_path / "chip")))
    assert driver.tick_us == pytest.approx(4.08)
    driver.close()


def test_every_driver_of_the_table_says_what_settings_it_obeys() -> None:
    from importlib import import_module

    for module in DRIVERS.values():
        assert "frequency_hz" in import_module(module).SETTINGS.__struct_fields__


@pytest.mark.parametrize("name", DRIVERS)
@pytest.mark.parametrize("seconds", [-0.1, 10.1, float("nan"), "long"])
def test_arming_for_no_time_there_is_is_refused(name: str, seconds: object) -> None:
    with pytest.raises(ConfigError, match=rf"drivers\.{name}\.arming: expected a number from 0 to 10"):
        open_driver(name, {"arming": seconds})


@pytest.mark.parametrize("name", ["pca9685", "simulated"])
def test_the_tick_of_settings_is_known_before_the_chip_is_opened(name: str) -> None:
    assert tick_us(name, {"frequency_hz": 50}) == pytest.approx(4.88)
    assert tick_us(name, {"osc_hz": 26e6}) == pytest.approx(106 / 26)


def test_the_tick_of_a_chip_without_a_prescaler_is_a_4096th_of_its_period() -> None:
    assert tick_us("sysfs_pwm", {"frequency_hz": 50}) == 20_000 / 4096
