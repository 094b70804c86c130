from pathlib import Path

import pytest

from zteleop.control.cap import AT_EASE
from zteleop.machine.health import GREAT_HEAT, HEAT, KEPT, UNDERVOLTAGE, Health


class Log:
    def __init__(self) -> None:
        self.infos: list[str] = []
        self.warnings: list[str] = []

    def info(self, text: str) -> None:
        self.infos.append(text)

    def warn(self, text: str) -> None:
        self.warnings.append(text)


class Pi:
    """A fake /sys of a Raspberry Pi, among whose devices are others."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.put("class/hwmon/hwmon0/name", "cpu_thermal\n")
        self.put("class/hwmon/hwmon1/name", "rpi_volt\n")
        self.put("class/thermal/thermal_zone0/type", "gpu-thermal\n")
        self.put("class/thermal/thermal_zone0/temp", "99000\n")
        self.put("class/thermal/thermal_zone1/type", "cpu-thermal\n")
        self.volt(0)
        self.heat(45.0)

    def put(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def volt(self, alarm: int | str) -> None:
        self.put("class/hwmon/hwmon1/in0_lcrit_alarm", f"{alarm}\n")

    def heat(self, celsius: float) -> None:
        self.put("class/thermal/thermal_zone1/temp", f"{celsius * 1000:.0f}\n")


@pytest.fixture
def pi(tmp_path: Path) -> Pi:
    return Pi(tmp_path)


@pytest.fixture
def log() -> Log:
    return Log()


@pytest.fixture
def health(pi: Pi, log: Log) -> Health:
    return Health(pi.root, log)


def test_a_pi_that_is_well_says_nothing(health: Health, log: Log) -> None:
    assert health.look(1.0) == AT_EASE
    assert log.warnings == log.infos == []


def test_undervoltage_halves_the_speed_until_it_is_over_for_a_while(pi: Pi, health: Health, log: Log) -> None:
    pi.volt(1)
    assert health.look(1.0) == health.look(2.0) == UNDERVOLTAGE
    pi.volt(0)
    assert health.look(2.0 + KEPT) == UNDERVOLTAGE
    assert health.look(2.1 + KEPT) == AT_EASE
    assert log.warnings == [
        "at most 50% of full speed: the Pi's supply is too low (undervoltage); use a better one"
    ]
    assert log.infos == ["the Pi's supply and heat are good again; full speed"]


def test_what_comes_and_goes_is_told_once(pi: Pi, health: Health, log: Log) -> None:
    for second in range(60):
        pi.volt(second % 2)
        health.look(float(second))
    assert (len(log.warnings), len(log.infos)) == (1, 0)


@pytest.mark.parametrize(
    ("celsius", "strain"),
    [(79.9, AT_EASE), (80.0, HEAT), (84.9, HEAT), (85.0, GREAT_HEAT), (110, GREAT_HEAT)],
)
def test_heat_slows_down_in_two_steps(pi: Pi, health: Health, celsius: float, strain: object) -> None:
    pi.heat(celsius)
    assert health.look(1.0) == strain


def test_of_two_strains_the_worse_counts_and_each_is_told(pi: Pi, health: Health, log: Log) -> None:
    pi.volt(1)
    assert health.look(1.0) == UNDERVOLTAGE
    pi.heat(86.0)
    assert health.look(2.0) == GREAT_HEAT
    pi.heat(60.0)
    assert health.look(7.1) == UNDERVOLTAGE
    assert len(log.warnings) == 3


@pytest.mark.parametrize("text", ["", "what?", "1" * 5000, "-1"])
def test_what_cannot_be_read_is_no_strain(pi: Pi, health: Health, text: str) -> None:
    pi.volt(text)
    assert health.look(1.0) == AT_EASE


def test_files_that_go_away_are_no_strain(pi: Pi, health: Health) -> None:
    pi.heat(86.0)
    health.look(1.0)
    for name in ("class/thermal/thermal_zone1/temp", "class/hwmon/hwmon1/in0_lcrit_alarm"):
        (pi.root / name).unlink()
    assert health.look(20.0) == AT_EASE


def test_any_other_computer_is_left_alone_however_hot(pi: Pi, log: Log) -> None:
    pi.heat(95.0)
    pi.put("class/hwmon/hwmon1/name", "coretemp\n")
    assert Health(pi.root, log).look(1.0) == AT_EASE
    pi.put("firmware/devicetree/base/model", "Raspberry Pi 5 Model B Rev 1.0\0")
    assert Health(pi.root, log).look(1.0) == GREAT_HEAT


def test_a_computer_without_any_of_this_says_nothing(tmp_path: Path, log: Log) -> None:
    assert Health(tmp_path / "none", log).look(1.0) == AT_EASE
    assert log.warnings == []
