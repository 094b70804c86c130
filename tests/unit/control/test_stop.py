from zteleop.control.stop import MERGED, PRESSERS, REMEMBERED, Latch, is_persons, stopped_by, whose
from zteleop.messages import Stop


def stop(identity: int, by: str = "ann", why: str = "") -> Stop:
    return Stop(engaged=True, id=identity, by=by, why=why)


def release(identity: int) -> Stop:
    return Stop(engaged=False, id=identity, by="ann", why="")


def test_a_stop_stays_and_its_repetitions_change_nothing() -> None:
    latch = Latch()
    assert latch.obey(stop(1))
    assert not latch.obey(stop(1, by="its echo"))
    assert latch.stops == (stop(1),)


def test_only_its_own_name_releases_it() -> None:
    latch = Latch([stop(1)])
    latch.obey(release(2))
    assert latch.stops == (stop(1),)
    assert latch.obey(release(1))
    assert latch.stops == ()
    assert not latch.obey(release(1))


def test_what_is_heard_late_of_a_released_stop_never_engages_again() -> None:
    latch = Latch([stop(1)])
    latch.obey(release(1))
    assert not latch.obey(stop(1))
    assert latch.stops == ()


def test_a_newer_stop_of_the_same_presser_takes_the_place_of_the_older_for_good() -> None:
    latch = Latch([stop(1)])
    assert latch.obey(stop(2))
    assert not latch.obey(stop(1))
    assert latch.stops == (stop(2),)
    assert latch.obey(release(2))
    assert not latch.obey(stop(1))
    assert latch.stops == ()


def test_the_release_of_an_older_stop_releases_no_newer_one() -> None:
    latch = Latch([stop(1)])
    latch.obey(stop(2))
    assert not latch.obey(release(1))
    assert latch.stops == (stop(2),)


def test_stops_of_two_people_add_up_and_neither_falls_with_the_others() -> None:
    latch = Latch([stop(1, "ann"), stop(2, "bob")])
    assert latch.obey(release(2))
    assert latch.stops == (stop(1, "ann"),)
    assert latch.obey(release(1))
    assert latch.stops == ()


def test_a_release_heard_before_its_stop_ends_it_in_advance() -> None:
    latch = Latch([stop(1, "ann")])
    assert latch.obey(release(2))
    assert not latch.obey(stop(2, "bob"))
    assert latch.stops == (stop(1, "ann"),)


def test_beyond_a_crowd_the_stops_are_one_that_bears_no_name_of_theirs() -> None:
    latch = Latch(stop(number, f"{number}@desk") for number in range(1, PRESSERS + 1))
    assert latch.obey(stop(1001, "late@desk"))
    latch.obey(stop(1002, "later@desk"))
    assert len(latch.stops) == PRESSERS + 1
    assert latch.stops[-1] == MERGED
    for number in (1001, 1002, *range(1, PRESSERS + 1)):
        latch.obey(release(number))
    assert latch.stops == (MERGED,)
    latch.obey(stop(1003, MERGED.by))
    latch.obey(release(1003))
    assert latch.stops == (MERGED,), "pressed by its name, and released"
    assert latch.obey(release(MERGED.id))
    assert latch.stops == ()
    for number in range(2000, 2000 + PRESSERS + 1):
        latch.obey(stop(number, f"{number}@desk"))
    assert latch.stops[-1] == MERGED


def test_what_ended_otherwise_is_forgotten_and_the_rest_stays() -> None:
    latch = Latch([stop(1, "ann"), stop(2, "bob")])
    latch.forget([1, 7])
    assert latch.stops == (stop(2, "bob"),)
    assert latch.without(2) == []


def test_only_a_person_has_a_stop_of_their_own() -> None:
    assert is_persons(stop(1, "ann@desk"))
    assert not is_persons(stop(1, "the watchdog"))
    assert not is_persons(stop(1, ""))


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
    assert stopped_by([stop(1, why="a cat")]) == (
        "stopped by ann: a cat; zteleop stop --release, then begin from neutral"
    )
    assert stopped_by([stop(1, by="")]).startswith("stopped by somebody; ")


def test_several_stops_are_told_by_name_and_a_crowd_by_number() -> None:
    both = [stop(1, "ann", "a cat"), stop(2, "bob")]
    assert stopped_by(both) == (
        "stopped by ann (a cat) and bob; each releases their own, then begin from neutral"
    )
    assert whose([stop(number, f"p{number}") for number in range(9)]) == "p0, p1, p2 and 6 more"


def test_the_last_stop_that_was_released_is_known() -> None:
    latch = Latch([stop(7)])
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
