import pytest

from zteleop.control.deadlines import ACTUATOR_SILENCE, ACTUATOR_START, LATE_STEP, LONGEST_START
from zteleop.control.patience import AT_MOST, FORGIVE_EVERY, PER_LOOK, Patience

LITTLE = 0.01


@pytest.mark.parametrize(
    ("took", "limit"),
    [(0.0, ACTUATOR_SILENCE), (0.1, ACTUATOR_SILENCE + PER_LOOK * 0.1), (9.0, ACTUATOR_SILENCE + AT_MOST)],
)
def test_a_slow_bus_makes_it_more_patient_but_not_for_ever(took: float, limit: float) -> None:
    patience = Patience(0.0)
    over = [patience.is_over(silence, took, ready=True, now=10.0) for silence in (limit, limit + LITTLE)]
    assert over == [False, True]


def test_one_that_never_stepped_leaves_the_next_more_time_until_one_steps() -> None:
    patience = Patience(0.0)
    had = []
    for _ in range(6):
        had.append(next(s for s in range(100) if patience.is_over(s + LITTLE, 0.0, ready=False, now=1000.0)))
        said = patience.lose(had[-1], ready=False)
    assert had == [ACTUATOR_START * 2**n for n in range(4)] + [LONGEST_START] * 2
    assert said == "it did not step within 60 s of its start, and the next has 60 s"
    patience.restore()
    assert patience.is_over(ACTUATOR_START + LITTLE, 0.0, ready=False, now=2000.0)


def test_what_nobody_listened_to_is_no_silence() -> None:
    patience = Patience(0.0)
    patience.tick(3.0 + LATE_STEP)
    woke = 3.0 + LATE_STEP
    assert not patience.is_over(3.0, 0.0, ready=True, now=woke + ACTUATOR_SILENCE)
    assert patience.is_over(3.0, 0.0, ready=True, now=woke + ACTUATOR_SILENCE + LITTLE)


def test_a_watchdog_that_is_always_late_still_loses_patience() -> None:
    patience = Patience(0.0)
    now, over = 0.0, []
    while now < FORGIVE_EVERY:
        now += LATE_STEP + LITTLE
        patience.tick(now)
        over.append(patience.is_over(now, 0.0, ready=True, now=now))
    assert over[:2] == [False, False]
    assert all(over[2:-1])


def test_it_says_how_long_the_silence_was() -> None:
    assert Patience(0.0).lose(0.267, ready=True) == "it was silent for 0.27 s"
