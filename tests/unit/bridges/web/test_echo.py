from types import SimpleNamespace

import pytest

from zteleop.bridges.web.echo import Echo
from zteleop.bridges.web.words import Held
from zteleop.messages import Beat

NEWEST = Beat(7, 100.0, 90.0)


def echoed(epoch: int, beat: float, newest: Beat | None = NEWEST) -> Beat | None:
    heard = SimpleNamespace(beat=newest, vehicle="a car", awake_since=3.0)
    echo = Echo(heard, lambda: Held(1, 0.0, 0.0, True, epoch, beat))
    assert (echo.vehicle, echo.awake_since) == ("a car", 3.0)
    return echo.beat


def test_a_page_proves_what_it_has_heard_itself_and_not_what_its_server_has() -> None:
    assert echoed(7, 99.5) == Beat(7, 99.5, 90.0)


@pytest.mark.parametrize("beat", [100.1, float("inf")])
def test_a_page_cannot_have_heard_what_was_not_said(beat: float) -> None:
    assert echoed(7, beat) == NEWEST


def test_of_another_start_or_of_a_robot_that_is_not_heard_there_is_none() -> None:
    assert echoed(6, 99.5) is None
    assert echoed(7, 99.5, newest=None) is None
