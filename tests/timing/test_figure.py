"""The figure that `zteleop demo` drives where there is no terminal, second by second."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from rig import Rig

LINE = re.compile(r" *(\d+) s  (\w+) +(-?\d+\.\d\d) m/s .* throttle (\d+)  steering (\d+)")


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        yield bench


def test_it_drives_all_the_time_and_says_so_every_second(rig: Rig) -> None:
    figure = rig.run("demo")
    assert figure.ends() == 0
    lines = [LINE.match(line) for line in figure.lines[1:-1]]
    assert all(lines), figure.text
    seconds, states, speeds, throttles, steerings = zip(
        *(line.groups() for line in lines if line), strict=True
    )
    assert [int(second) for second in seconds] == list(range(len(seconds)))
    assert len(seconds) in (10, 11)
    assert set(states) <= {"driving", "idle"}
    assert max(map(float, speeds)) > 0.3
    assert max(map(int, throttles)) > 370
    assert min(map(int, steerings)) < 375 < max(map(int, steerings))
