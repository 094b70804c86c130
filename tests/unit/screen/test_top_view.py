from math import cos, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.screen.boards import text
from unit.screen.pictures import dots, middle

from zteleop.messages import Odometry
from zteleop.screen.top_view import MARGIN, SPANS, Mark, choose_window, draw, pose


def odometry(x: float, y: float, heading: float = 0.0) -> Odometry:
    odom = Odometry.zero()
    odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
    odom.pose.pose.orientation.z, odom.pose.pose.orientation.w = sin(heading / 2), cos(heading / 2)
    return odom


def picture(odom=None, trail=(), vehicle=None, columns=60, rows=30, unicode=True, floor=()) -> list[str]:
    return [text(spans) for spans in draw(odom, trail, 0.0, vehicle, columns, rows, unicode, floor)]


def test_driving_forward_and_left_moves_it_up_and_to_the_left(car):
    start = middle(dots(picture(odometry(0, 0), vehicle=car)[:-1]))
    ahead = middle(dots(picture(odometry(0.3, 0.3), vehicle=car)[:-1]))
    assert ahead[0] < start[0] - 10
    assert ahead[1] < start[1] - 10


def test_the_trail_is_where_it_was_and_jumps_are_not_joined(car):
    here = odometry(0, 0)
    bare = dots(picture(here, vehicle=car))
    drawn = dots(picture(here, [(-0.7, y / 10) for y in range(-5, 6)], car)) - bare
    assert {y for _, y in drawn} == {60 + 28}
    assert {x for x, _ in drawn} == set(range(40, 81))
    assert dots(picture(here, [(-0.7, -0.5), (-0.7, 0.5)], car)) == bare


def test_what_lies_on_the_floor_is_drawn_under_the_robot(car):
    line = Mark([(-1.0, -1.0), (-1.0, 1.0)], "yellow")
    bare = dots(picture(odometry(0, 0), vehicle=car))
    assert {y for _, y in dots(picture(odometry(0, 0), vehicle=car, floor=[line])) - bare} == {100}
    spans = draw(odometry(0, 0), [], 0.0, car, 60, 30, True, [line])[25]
    assert {span.style for span in spans} == {"", "yellow"}


@given(st.lists(st.tuples(st.floats(-8, 8), st.floats(-8, 8)), min_size=1, max_size=9))
def test_the_whole_trail_is_in_sight(places):
    window = choose_window(places, 108, 80)
    for x, y in map(window.place, places):
        assert 0 <= x < 108
        assert 0 <= y < 80


def test_a_picture_holds_where_the_robot_has_been(car):
    here, bar = odometry(0, 0), 20
    near = picture(here, [(0.0, 0.0)], car)[-1].count("─")
    assert near == bar - 2
    assert picture(here, [(-5.0, 0.0), (0.0, 0.0)], car)[-1].count("─") < near / 2


def test_it_looks_as_closely_as_the_trail_allows():
    close = choose_window([(0.0, 0.0)], 108, 80)
    far = choose_window([(0.0, 0.0), (10.0, 0.0)], 108, 80)
    assert close.dots_per_m == pytest.approx(80 / SPANS[0])
    assert far.dots_per_m >= 80 / (10.0 + 2 * MARGIN) / 1.5


def test_what_no_window_holds_is_seen_where_the_robot_is():
    window = choose_window([(500.0, 0.0), (0.0, 0.0)], 108, 80)
    x, y = window.place((500.0, 0.0))
    assert 0 <= x < 108
    assert 0 <= y < 80


def test_a_robot_stays_where_it_is_while_it_drives_a_little():
    assert len({choose_window([(x / 100, 0.0)], 108, 80).middle for x in range(30)}) == 1


def test_a_metre_is_as_long_as_the_bar_says(car):
    assert picture(odometry(0, 0), vehicle=car)[-1].startswith("├──────────────────┤ 1 m")
    ascii_bar = picture(odometry(0, 0), vehicle=car, unicode=False)[-1]
    assert ascii_bar.startswith("|------------------| 1 m")


@pytest.mark.parametrize(("rows", "words"), [(30, "1 m  robot 2x"), (10, "1 m  robot 4x"), (60, "1 m")])
def test_a_robot_drawn_larger_than_life_says_so(car, rows, words):
    bar = picture(odometry(0, 0), vehicle=car, columns=140, rows=rows)[-1]
    assert bar.rstrip().endswith(f"┤ {words}")


def test_without_a_place_there_is_a_robot_as_large_as_with_one_and_no_scale(car):
    known = len(dots(picture(odometry(0, 0), vehicle=car)[:-1]))
    for odom in (None, odometry(1e300, 0), odometry(0, 0, float("nan"))):
        shown = picture(odom, vehicle=car)
        assert len(dots(shown)) == known
        assert "1 m" not in shown[-1]
    assert pose(odometry(float("inf"), 0)) is None


@given(
    st.integers(1, 60),
    st.integers(1, 30),
    st.floats(),
    st.floats(),
    st.floats(-4, 4),
    st.floats(),
    st.lists(st.tuples(st.floats(), st.floats()), max_size=5),
    st.booleans(),
)
def test_any_place_fits_any_picture(columns, rows, x, y, heading, steering, trail, unicode):
    found = draw(odometry(x, y, heading), trail, steering, None, columns, rows, unicode)
    lines = [text(spans) for spans in found]
    assert [len(line) for line in lines] == [columns] * rows
    assert unicode or all(line.isascii() for line in lines)
