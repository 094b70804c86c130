from math import atan2, cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.messages import Odometry
from zteleop.screen.top_view import Canvas, draw, pose, slope, window


def odometry(x: float, y: float, heading: float) -> Odometry:
    odom = Odometry.zero()
    odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
    odom.pose.pose.orientation.z, odom.pose.pose.orientation.w = sin(heading / 2), cos(heading / 2)
    return odom


def dots(lines: list[str]) -> set[tuple[int, int]]:
    """The dots of a braille picture: x to the right, y down."""
    bits = {
        0x01: (0, 0),
        0x02: (0, 1),
        0x04: (0, 2),
        0x40: (0, 3),
        0x08: (1, 0),
        0x10: (1, 1),
        0x20: (1, 2),
        0x80: (1, 3),
    }
    return {
        (2 * column + dx, 4 * row + dy)
        for row, line in enumerate(lines)
        for column, character in enumerate(line)
        if 0x2800 <= ord(character) < 0x2900
        for bit, (dx, dy) in bits.items()
        if (ord(character) - 0x2800) & bit
    }


def middle(places: set[tuple[int, int]]) -> tuple[float, float]:
    return sum(x for x, _ in places) / len(places), sum(y for _, y in places) / len(places)


def lean(places: set[tuple[int, int]]) -> float:
    """The direction of the long side of a cloud of dots, in rad from straight up, positive to the left."""
    mx, my = middle(places)
    xx = sum((x - mx) ** 2 for x, _ in places)
    yy = sum((y - my) ** 2 for _, y in places)
    xy = sum((x - mx) * (y - my) for x, y in places)
    return atan2(2 * xy, yy - xx) / 2


@pytest.mark.parametrize("angle", [0.4, 0.2, 0.0, -0.2, -0.4])
def test_the_front_wheels_point_where_the_steering_does(car, angle):
    picture = dots(draw(None, [], angle, car, 60, 30, True))
    left_front = {(x, y) for x, y in picture if x < 42 and y < 55}
    left_rear = {(x, y) for x, y in picture if x < 42 and y > 65}
    assert lean(left_front) == pytest.approx(angle, abs=0.12)
    assert lean(left_rear) == pytest.approx(0.0, abs=0.12)


@pytest.mark.parametrize(
    ("heading", "nose"), [(0, (0, -1)), (pi / 2, (-1, 0)), (pi, (0, 1)), (-pi / 2, (1, 0))]
)
def test_x_is_up_and_y_is_left(car, heading, nose):
    lines = draw(odometry(0, 0, heading), [], 0.0, car, 60, 30, False)
    cells = {
        mark: [(c, r) for r, line in enumerate(lines[:-1]) for c, m in enumerate(line) if m == mark]
        for mark in "o#"
    }
    front, body = (middle(set(cells[mark])) for mark in "o#")
    ahead = front[0] - body[0], 2 * (front[1] - body[1])
    assert ahead[0] * nose[0] + ahead[1] * nose[1] > 4


def test_driving_forward_and_left_moves_it_up_and_to_the_left(car):
    start = middle(dots(draw(odometry(0, 0, 0), [], 0.0, car, 60, 30, True)[:-1]))
    ahead = middle(dots(draw(odometry(0.5, 0.5, 0), [], 0.0, car, 60, 30, True)[:-1]))
    assert ahead[0] < start[0] - 10
    assert ahead[1] < start[1] - 10


def test_the_trail_is_where_it_was_and_jumps_are_not_joined(car):
    here = odometry(0, 0, 0)
    bare = dots(draw(here, [], 0.0, car, 60, 30, True))
    trail = [(-1.5, y / 10) for y in range(11)]
    drawn = dots(draw(here, trail, 0.0, car, 60, 30, True)) - bare
    assert {y for _, y in drawn} == {60 + 45}
    assert {x for x, _ in drawn} == set(range(30, 61))
    assert dots(draw(here, [(-1.5, -1.5), (-1.5, 1.5)], 0.0, car, 60, 30, True)) == bare


def test_a_metre_is_as_long_as_the_bar_says(car):
    bar = draw(odometry(0, 0, 0), [], 0.0, car, 60, 30, True)[-1]
    assert bar.startswith("├─────────────┤ 1 m")
    assert draw(odometry(0, 0, 0), [], 0.0, car, 60, 30, False)[-1].startswith("|-------------| 1 m")


def test_a_tank_has_two_wheels_that_do_not_steer(tank):
    assert draw(None, [], 0.0, tank, 40, 20, True) == draw(None, [], 0.4, tank, 40, 20, True)


def test_without_a_place_there_is_a_robot_and_no_scale(car):
    for odom in (None, odometry(1e300, 0, 0), odometry(0, 0, float("nan"))):
        picture = draw(odom, [], 0.0, car, 40, 20, True)
        assert dots(picture)
        assert "1 m" not in picture[-1]
    assert pose(odometry(float("inf"), 0, 0)) is None


@given(st.floats(-1e5, 1e5), st.floats(1, 50))
def test_the_window_keeps_the_robot_in_its_middle_half(position, span):
    assert abs(position - window(position, span)) <= span / 4 * 1.001


@pytest.mark.parametrize(
    ("right", "down", "mark"), [(1, 0, "-"), (0, 1, "|"), (1, 2, "\\"), (1, -2, "/"), (-1, 2, "/")]
)
def test_a_line_is_the_character_of_its_slope(right, down, mark):
    assert slope(right, down) == mark


def test_what_is_outside_is_not_drawn():
    canvas = Canvas(2, 1, True)
    canvas.line((-5, -5), (-1, -1))
    canvas.dot(4, 0)
    assert canvas.lines() == ["  "]


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
    lines = draw(odometry(x, y, heading), trail, steering, None, columns, rows, unicode)
    assert [len(line) for line in lines] == [columns] * rows
    assert unicode or all(line.isascii() for line in lines)
