from zteleop.control.slowness import QUICK_WRITES, SLOW, SLOW_WRITES, Slowness

QUICK = SLOW / 10


def counted(*took: float) -> Slowness:
    bus = Slowness()
    for seconds in took:
        bus.count(seconds)
    return bus


def test_a_new_bus_is_neither_slow_nor_known_to_be_quick() -> None:
    bus = Slowness()
    assert (bus.is_slow, bus.lasts, bus.is_over) == (False, False, False)


def test_slow_writes_in_a_row_last() -> None:
    late = 2 * SLOW
    assert [counted(*[late] * n).lasts for n in (SLOW_WRITES - 1, SLOW_WRITES)] == [False, True]
    assert not counted(*[late] * (SLOW_WRITES - 1), QUICK, late).lasts
    assert not counted(*[SLOW] * SLOW_WRITES).lasts


def test_one_slow_write_is_known_until_the_next() -> None:
    assert counted(2 * SLOW).is_slow
    assert not counted(2 * SLOW, QUICK).is_slow


def test_it_is_over_after_many_quick_ones_in_a_row() -> None:
    slow = [2 * SLOW] * SLOW_WRITES
    assert [counted(*slow, *[QUICK] * n).is_over for n in (QUICK_WRITES - 1, QUICK_WRITES)] == [False, True]
    assert not counted(*[QUICK] * QUICK_WRITES, 2 * SLOW).is_over
