from zteleop.control.pace import QUICK_WRITES, SLOW, SLOW_WRITES, Pace

QUICK = SLOW / 10


def counted(*took: float) -> Pace:
    pace = Pace()
    for seconds in took:
        pace.count(seconds)
    return pace


def test_a_new_bus_neither_drags_nor_is_known_to_run() -> None:
    pace = Pace()
    assert (pace.is_slow, pace.drags, pace.runs) == (False, False, False)


def test_slow_writes_in_a_row_make_it_drag() -> None:
    late = 2 * SLOW
    assert [counted(*[late] * n).drags for n in (SLOW_WRITES - 1, SLOW_WRITES)] == [False, True]
    assert not counted(*[late] * (SLOW_WRITES - 1), QUICK, late).drags
    assert not counted(*[SLOW] * SLOW_WRITES).drags


def test_one_slow_write_is_known_until_the_next() -> None:
    assert counted(2 * SLOW).is_slow
    assert not counted(2 * SLOW, QUICK).is_slow


def test_it_runs_again_after_many_quick_ones_in_a_row() -> None:
    dragging = [2 * SLOW] * SLOW_WRITES
    assert [counted(*dragging, *[QUICK] * n).runs for n in (QUICK_WRITES - 1, QUICK_WRITES)] == [False, True]
    assert not counted(*[QUICK] * QUICK_WRITES, 2 * SLOW).runs
