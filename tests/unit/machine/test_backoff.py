from zteleop.machine.backoff import FIRST_PAUSE, LONGEST_PAUSE, STEADY, BackOff


def test_pauses_double_up_to_the_longest() -> None:
    backoff = BackOff()
    assert [backoff.pause(0.0) for _ in range(8)] == [FIRST_PAUSE * 2**n for n in range(6)] + [
        LONGEST_PAUSE
    ] * 2


def test_the_first_may_be_none() -> None:
    backoff = BackOff(first=0.0)
    assert [backoff.pause(0.0) for _ in range(3)] == [0.0, FIRST_PAUSE, 2 * FIRST_PAUSE]


def test_what_lived_for_long_begins_anew() -> None:
    backoff = BackOff(first=0.0)
    assert [backoff.pause(lived) for lived in (0.0, 0.0, STEADY, STEADY + 0.1)] == [0.0, 0.1, 0.2, 0.0]
