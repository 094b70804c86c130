"""How long a driver waits for a bus that hangs or is slow: on a device file, and on a simulated chip."""

from pathlib import Path

import preload
import pytest
from preload.contract import Bench
from preload.timed import measure
from verdict import judged

SHORT = ("hangs for 10 ms", 0.03, 0.3)
ONE_AFTER_THE_OTHER = ("slow", 0.04, 0.3)
AT_MOST_THE_TIMEOUT = ("hangs", 0.06, 0.5)
"""what happens, and s that it must and may take"""


@pytest.mark.parametrize(("name", "least", "most"), [SHORT, ONE_AFTER_THE_OTHER, AT_MOST_THE_TIMEOUT])
def test_on_a_device_file(name: str, least: float, most: float, tmp_path: Path) -> None:
    seconds, waited = preload.run(tmp_path, "timed", name)
    judged(seconds, most, waited, not_before=least)


@pytest.mark.parametrize(("name", "least", "most"), [SHORT, ONE_AFTER_THE_OTHER])
def test_on_a_simulated_chip(name: str, least: float, most: float, tmp_path: Path) -> None:
    bench = Bench(str(tmp_path / "chip"))
    try:
        seconds, waited = measure(name, bench)
    finally:
        bench.close()
    judged(seconds, most, waited, not_before=least)
