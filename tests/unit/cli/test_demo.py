from types import SimpleNamespace

import pytest

from zteleop.cli.demo import Teller
from zteleop.messages import DriveStatus, Odometry
from zteleop.testing import Clock


def view(clock: Clock, x: float = 0.0, heard: bool = True) -> SimpleNamespace:
    odom = Odometry.zero()
    odom.pose.pose.position.x = x
    status = DriveStatus.zero() if heard else None
    return SimpleNamespace(now=clock.time, odom=odom if heard else None, status=status)


def test_the_way_is_measured_from_the_first_place(clock: Clock) -> None:
    teller = Teller()
    for x in (5.0, 6.0, 5.5):
        teller(view(clock, x))
    assert teller.distance == pytest.approx(1.5)


def test_it_prints_a_line_a_second(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    teller = Teller()
    for _ in range(50):
        teller(view(clock))
        clock.pass_by(0.05)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["0", "1", "2"]
    assert "starting" in lines[0]


def test_before_the_robot_is_heard_it_says_nothing(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    Teller()(view(clock, heard=False))
    assert capsys.readouterr().out == ""
