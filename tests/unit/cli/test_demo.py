import socket
from types import SimpleNamespace

import pytest

from zteleop.cli import demo
from zteleop.cli.demo import ALONE, HIDDEN, LOOK_EVERY, Hidden, Teller, Trip, _is_taken, ended, farewell
from zteleop.messages import DriveStatus, Odometry
from zteleop.testing import Clock


def view(clock: Clock, x: float = 0.0, heard: bool = True, speed: float = 0.0) -> SimpleNamespace:
    odom = Odometry.zero()
    odom.pose.pose.position.x, odom.twist.twist.linear.x = x, speed
    status = DriveStatus.zero() if heard else None
    return SimpleNamespace(now=clock.time, odom=odom if heard else None, status=status)


def test_the_way_is_measured_from_the_first_place(clock: Clock) -> None:
    trip = Trip()
    trip(view(clock, heard=False))
    for x, speed in ((5.0, 0.0), (6.0, 0.5), (5.5, -0.7)):
        trip(view(clock, x, speed=speed))
    assert (trip.distance, trip.fastest) == (pytest.approx(1.5), 0.7)


@pytest.mark.parametrize(("drive", "other"), [("step", "hold"), ("hold", "step")])
def test_the_end_offers_the_other_drive(
    clock: Clock, drive: str, other: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.which", lambda name: name)
    trip = Trip()
    assert farewell(trip, drive).startswith("drove nowhere\ntry next:\n")
    assert f"  zteleop demo --drive {other} " in farewell(trip, drive)
    for x in (0.0, 2.0):
        trip(view(clock, x, speed=0.25))
    assert farewell(trip, drive).startswith("drove 2.0 m, 0.25 m/s at most\n")


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


@pytest.mark.parametrize(
    ("found", "typed", "words"),
    [
        (True, ["/here/bin/python", "/here/bin/zteleop"], "zteleop"),
        (False, ["/here/bin/python", ".venv/bin/zteleop"], ".venv/bin/zteleop"),
        (False, ["python3", "-m", "zteleop"], "python3 -m zteleop"),
    ],
)
def test_the_next_step_is_written_as_this_one_was_typed(
    monkeypatch: pytest.MonkeyPatch, found: bool, typed: list[str], words: str
) -> None:
    monkeypatch.setattr("shutil.which", lambda name: f"/here/bin/{name}" if found else None)
    monkeypatch.setattr("sys.orig_argv", [*typed, "demo"])
    first = "/here/zteleop/__main__.py" if "-m" in typed else typed[1]
    monkeypatch.setattr("sys.argv", [first, "demo"])
    assert f"\n  {words} demo --drive hold " in farewell(Trip(), "step")


def test_a_demo_that_others_do_not_see_says_so_until_a_part_of_it_is_gone() -> None:
    lives, gone = SimpleNamespace(poll=lambda: None), SimpleNamespace(poll=lambda: 1)
    assert ended([lives, lives]).lines == ()  # type: ignore[list-item]
    hidden = Hidden()
    assert ended([lives, lives], hidden).lines == [("demo", HIDDEN)]  # type: ignore[list-item]
    assert "its simulator ended" in ended([lives, gone], hidden).lines[0][1]  # type: ignore[list-item]


@pytest.mark.parametrize(("is_there", "words"), [(True, HIDDEN), (False, ALONE)])
def test_a_demo_says_when_whoever_hid_it_is_gone(
    clock: Clock, monkeypatch: pytest.MonkeyPatch, is_there: bool, words: str
) -> None:
    monkeypatch.setattr(demo, "_is_taken", lambda endpoint: is_there)
    hidden = Hidden()
    assert hidden.words == HIDDEN
    clock.pass_by(LOOK_EVERY)
    assert hidden.words == words


def test_a_door_is_taken_while_somebody_listens_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as door:
        endpoint = f"tcp/127.0.0.1:{door.getsockname()[1]}"
        assert _is_taken(endpoint)
    assert not _is_taken(endpoint)
