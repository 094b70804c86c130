import pytest

from zteleop.sim.create3.backup import BUFFER, BackupLimit


def test_it_knows_no_way_back_at_the_start() -> None:
    limit = BackupLimit()
    assert limit.is_reached
    assert limit.is_near


def test_what_it_went_forward_it_may_go_back_up_to_15_cm() -> None:
    limit = BackupLimit()
    limit.roll(0.1)
    assert limit.left == pytest.approx(0.1)
    limit.roll(5.0)
    assert limit.left == BUFFER == 0.15
    limit.roll(-0.099)
    assert not limit.is_near
    limit.roll(-0.002)
    assert limit.is_near
    assert not limit.is_reached
    limit.roll(-1.0)
    assert limit.is_reached
    assert limit.left == 0.0


def test_whoever_reverses_although_warned_ignores_it_until_forward() -> None:
    limit = BackupLimit()
    assert not limit.ignored
    limit.reverse()
    limit.roll(0.0)
    assert limit.ignored
    limit.roll(0.001)
    assert not limit.ignored


def test_reversing_where_the_way_is_known_ignores_nothing() -> None:
    limit = BackupLimit()
    limit.roll(0.15)
    limit.reverse()
    assert not limit.ignored
