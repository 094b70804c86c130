"""The real driver, the real smbus2 and a /dev/i2c-1 of our own: one process does every case and reports."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import preload
import pytest
from preload.device import DEVICE_CASES

from zteleop.drivers.faults import Faults, next_fault


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str | None]:
    outcomes: dict[str, str | None] = preload.run(tmp_path_factory.mktemp("i2cdev"), "device")
    return outcomes


@pytest.mark.parametrize("name", [case.__name__ for case in DEVICE_CASES])
def test_on_a_device_file(found: dict[str, str | None], name: str) -> None:
    assert found[name] is None, found[name]


def test_several_drivers_of_a_chip_meet_as_many_faults_as_were_put_in(tmp_path: Path) -> None:
    path = str(tmp_path / "chip")
    with Faults(path) as faults, ThreadPoolExecutor(4) as drivers:
        faults.nack(400)
        met = drivers.map(next_fault, [path] * 500)
        assert sum(fault is not None for fault in met) == 400
        assert faults.pending().nack == 0
