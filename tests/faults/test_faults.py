"""Each fault a few times; `make faults` does it fifty times and prints a table."""

from pathlib import Path

import pytest
from faults.faults import FAULTS, Fault, driven, measure, on_i2c

BUSY = 0.1
"""s more than the bound, which a machine that runs other tests may take"""


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name.replace(" ", "-"))
def test_a_fault_brings_neutral_in_time_and_for_good(tmp_path: Path, fault: Fault) -> None:
    with driven(tmp_path, alone=fault.alone) as bench:
        assert measure(fault, bench) <= fault.bound + BUSY


@pytest.mark.parametrize("name", ["actuator killed", "actuator frozen", "watchdog killed", "stop pressed"])
def test_the_real_driver_keeps_the_same_bounds(tmp_path: Path, name: str) -> None:
    (fault,) = (fault for fault in FAULTS if fault.name == name)
    with driven(tmp_path, alone=fault.alone, prepare=on_i2c) as bench:
        assert measure(fault, bench) <= fault.bound + BUSY
