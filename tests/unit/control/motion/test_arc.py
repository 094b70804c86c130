from math import cos, pi, sin
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.motion.arc import MOST, Circle, fit_circle, last_arc, rms_off

Path = list[tuple[float, float]]


def arc(radius: float, turn: float, count: int, x: float = 0.0, y: float = 0.0, begin: float = 0.0) -> Path:
    """Points of a path that turns by so many rad, to the left where that is positive."""
    angles = [begin + turn * i / (count - 1) for i in range(count)]
    return [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]


def shaken(points: Path, spread: float, seed: int = 1) -> Path:
    chance = Random(seed)
    return [(x + chance.gauss(0, spread), y + chance.gauss(0, spread)) for x, y in points]


def test_a_circle_through_three_points() -> None:
    circle = fit_circle([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)])
    assert circle == pytest.approx((0.0, 0.0, 1.0))


def test_a_path_to_the_right_has_a_negative_radius() -> None:
    circle = fit_circle([(-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)])
    assert circle == pytest.approx((0.0, 0.0, -1.0))


@pytest.mark.parametrize("points", [[], [(1.0, 2.0)], [(0.0, 0.0), (1.0, 1.0)]])
def test_fewer_points_make_no_circle(points: Path) -> None:
    assert fit_circle(points) is None


@pytest.mark.parametrize("heading", [0.0, 0.7, pi / 2, 3.0])
@pytest.mark.parametrize("count", [3, 10, 400])
def test_a_straight_line_is_no_circle(heading: float, count: int) -> None:
    line = [(5 + 0.05 * i * cos(heading), 0.05 * i * sin(heading)) for i in range(count)]
    assert fit_circle(line) is None


def test_an_arc_of_a_degree_is_straight_and_one_of_five_is_not() -> None:
    assert fit_circle(arc(10.0, pi / 180, 20)) is None
    assert fit_circle(arc(10.0, 5 * pi / 180, 20)) == pytest.approx((0.0, 0.0, 10.0), abs=1e-6)


def test_points_at_one_place_are_no_circle() -> None:
    assert fit_circle([(1.0, 1.0)] * 10) is None


@pytest.mark.parametrize("seed", range(20))
def test_noise_around_a_place_or_along_a_line_is_no_circle(seed: int) -> None:
    assert fit_circle(shaken([(0.0, 0.0)] * 50, 0.01, seed)) is None
    assert fit_circle(shaken([(0.05 * i, 0.0) for i in range(50)], 0.005, seed)) is None


@pytest.mark.parametrize("seed", range(20))
def test_noise_of_half_a_cm_changes_the_radius_of_a_lap_by_less(seed: int) -> None:
    circle = fit_circle(shaken(arc(0.5, -2 * pi, 60), 0.005, seed))
    assert circle is not None
    assert circle.radius == pytest.approx(-0.5, abs=0.005)
    assert rms_off(circle, arc(0.5, -2 * pi, 60)) < 0.005


def test_an_arc_that_noise_hides_is_not_measured_at_all() -> None:
    assert fit_circle(shaken(arc(0.5, 0.4, 30), 0.01)) is None


@given(
    st.floats(0.01, 100),
    st.floats(0.1, 6.2),
    st.booleans(),
    st.integers(3, 50),
    st.floats(-100, 100),
    st.floats(-100, 100),
    st.floats(-pi, pi),
)
def test_any_arc_is_found_again(
    radius: float, turn: float, right: bool, count: int, x: float, y: float, begin: float
) -> None:
    if count == 3 and turn > 5:  # half of the way round between two points has no side any more
        turn = 3.0
    side = -1 if right else 1
    circle = fit_circle(arc(radius, side * turn, count, x, y, begin))
    assert circle is not None
    assert circle.radius == pytest.approx(side * radius, rel=1e-3)
    assert (circle.x, circle.y) == pytest.approx((x, y), abs=1e-3 * radius + 1e-6)


@given(st.lists(st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)), max_size=30))
def test_any_path_has_a_circle_or_none(points: Path) -> None:
    circle = fit_circle(points)
    assert circle is None or abs(circle.radius) > 0


def test_the_last_arc_is_the_one_at_the_end() -> None:
    first = arc(1.0, pi, 60)
    then = arc(0.5, -pi, 60, x=-1.5, begin=0.0)
    circle = last_arc([*first, *then])
    assert circle is not None
    assert circle == pytest.approx((-1.5, 0.0, -0.5), abs=0.02)


def test_a_few_points_after_a_bend_are_no_arc_yet() -> None:
    assert last_arc(arc(0.5, 0.4, 4)) is None


def test_after_a_straight_way_there_is_no_last_arc() -> None:
    assert last_arc([*arc(0.5, pi, 40), *((-0.5, -0.05 * i) for i in range(1, 20))]) is None


def test_no_more_of_a_path_is_looked_at_than_it_takes() -> None:
    near, far = arc(0.508, 2 * pi, MOST), arc(0.5, 6 * pi, 300)
    assert last_arc([*far, *near]) == pytest.approx((0.0, 0.0, 0.508), abs=1e-9)


def test_a_circle_knows_how_far_off_a_place_is() -> None:
    assert Circle(1.0, 0.0, -2.0).off((1.0, 5.0)) == 3.0
