from zteleop.nodes.camera import LONGEST_GAP, Pace

PICTURE = 30_000


def test_of_a_camera_that_is_faster_than_asked_some_are_left_out() -> None:
    pace = Pace()
    assert sum(pace.takes(number / 30, 10.0, 0, PICTURE) for number in range(300)) == 100


def test_a_camera_that_is_as_fast_as_asked_loses_none_by_a_little_haste() -> None:
    pace = Pace()
    moments = [number / 20 + 0.004 * (number % 2) for number in range(100)]
    assert all(pace.takes(moment, 20.0, 0, PICTURE) for moment in moments)


def test_while_a_link_is_full_a_picture_waits_for_no_longer_than_a_second() -> None:
    pace = Pace()
    said = [number / 20 for number in range(100) if pace.takes(number / 20, 20.0, PICTURE, PICTURE)]
    assert said == [0.0, *(LONGEST_GAP * second for second in range(1, 5))]
    assert pace.count() == (5, 95)
    assert pace.count() == (0, 0)


def test_what_has_nearly_left_holds_nothing_back() -> None:
    pace = Pace()
    assert pace.takes(0.0, 20.0, PICTURE // 3, PICTURE)
    assert pace.takes(0.05, 20.0, PICTURE // 3, PICTURE)
