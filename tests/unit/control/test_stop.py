from zteleop.control.stop import REMEMBERED, Latch, describe
from zteleop.messages import Stop


def stop(identity: int, by: str = "ann", why: str = "") -> Stop:
    return Stop(engaged=True, id=identity, by=by, why=why)


def release(identity: int) -> Stop:
    return Stop(engaged=False, id=identity, by="ann", why="")


def test_a_stop_stays_and_its_repetitions_change_nothing() -> None:
    latch = Latch()
    assert latch.obey(stop(1))
    assert not latch.obey(stop(1, by="its echo"))
    assert latch.stop == stop(1)


def test_only_its_own_name_releases_it() -> None:
    latch = Latch(stop(1))
    assert not latch.obey(release(2))
    assert latch.stop
    assert latch.obey(release(1))
    assert latch.stop is None
    assert not latch.obey(release(1))


def test_what_is_heard_late_of_a_released_stop_never_engages_again() -> None:
    latch = Latch(stop(1))
    latch.obey(release(1))
    assert not latch.obey(stop(1))
    assert latch.stop is None


def test_a_newer_stop_takes_the_place_of_an_older_one_for_good() -> None:
    latch = Latch(stop(1))
    assert latch.obey(stop(2))
    assert not latch.obey(stop(1))
    assert latch.stop == stop(2)
    assert latch.obey(release(2))
    assert not latch.obey(stop(1))
    assert latch.stop is None


def test_the_release_of_an_older_stop_releases_no_newer_one() -> None:
    latch = Latch(stop(1))
    latch.obey(stop(2))
    assert not latch.obey(release(1))
    assert latch.stop == stop(2)


def test_a_nameless_stop_is_meant_each_time_and_released_as_such() -> None:
    latch = Latch()
    assert latch.obey(stop(0))
    assert not latch.obey(stop(0))
    assert latch.obey(release(0))
    assert latch.obey(stop(0))


def test_its_memory_is_bounded_and_forgets_the_oldest() -> None:
    latch = Latch()
    for identity in range(1, REMEMBERED + 2):
        assert latch.obey(stop(identity))
        assert latch.obey(release(identity))
    assert len(latch._known) == REMEMBERED
    assert not latch.obey(stop(2))
    assert latch.obey(stop(1))


def test_the_stop_in_force_is_known_however_many_were_before() -> None:
    latch = Latch()
    for identity in range(1, 3 * REMEMBERED):
        latch.obey(stop(identity))
        assert not latch.obey(stop(identity))


def test_a_stop_in_words_says_how_to_go_on() -> None:
    assert describe(stop(1, why="a cat")) == (
        "stopped by ann: a cat; zteleop stop --release, then begin from neutral"
    )
    assert describe(stop(1, by="")).startswith("stopped by somebody; ")


def test_the_last_stop_that_was_released_is_known() -> None:
    latch = Latch(stop(7))
    assert latch.released == 0
    latch.obey(release(7))
    assert latch.released == 7
    latch.obey(stop(9))
    assert latch.released == 7
    latch.obey(release(9))
    assert latch.released == 9


def test_a_nameless_stop_is_another_than_the_one_before() -> None:
    latch = Latch()
    latch.released = 2**53 - 1
    seen = []
    for _ in range(2):
        latch.obey(stop(0))
        latch.obey(release(0))
        seen.append(latch.released)
    assert seen == [0, 1]
