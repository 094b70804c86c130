"""The contract on the simulated chip; `tests/system/test_i2cdev.py` holds the real driver to it."""

from pathlib import Path

import pytest
from preload.contract import CASES, Bench, Case, hold


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_on_a_simulated_chip(case: Case, tmp_path: Path) -> None:
    bench = Bench(str(tmp_path / "chip"))
    try:
        hold(case, bench)
    finally:
        bench.close()
