from math import pi

import pytest
from unit.screen.boards import text
from unit.screen.pictures import dots, lean, middle

from zteleop.messages import Vehicle
from zteleop.screen.canvas import Canvas
from zteleop.screen.chassis import draw_chassis, length_of


def draw(vehicle: Vehicle, heading: float = 0.0, steering: float = 0.0, unicode: bool = True) -> list[str]:
    canvas = Canvas(60, 30, unicode)
    draw_chassis(canvas, (60.0, 60.0), heading, steering, vehicle, 84.0)
    return [text(spans) for spans in canvas.lines()]


@pytest.mark.parametrize("angle", [0.4, 0.2, 0.0, -0.2, -0.4])
def test_the_front_wheels_point_where_the_steering_does(car, angle):
    picture = dots(draw(car, steering=angle))
    left_front = {(x, y) for x, y in picture if x < 42 and y < 55}
    left_rear = {(x, y) for x, y in picture if x < 42 and y > 65}
    assert lean(left_front) == pytest.approx(angle, abs=0.12)
    assert lean(left_rear) == pytest.approx(0.0, abs=0.12)


@pytest.mark.parametrize(("steering", "style"), [(0.0, set()), (0.3, {"cyan"})])
def test_wheels_that_steer_have_the_colour_of_steering(car, steering, style):
    canvas = Canvas(60, 30, True)
    draw_chassis(canvas, (60.0, 60.0), 0.0, steering, car, 84.0)
    assert {span.style for spans in canvas.lines() for span in spans} - {""} == style


@pytest.mark.parametrize(
    ("heading", "nose"), [(0, (0, -1)), (pi / 2, (-1, 0)), (pi, (0, 1)), (-pi / 2, (1, 0))]
)
def test_x_is_up_and_y_is_left(car, heading, nose):
    lines = draw(car, heading, unicode=False)
    cells = {
        mark: {(c, r) for r, line in enumerate(lines) for c, m in enumerate(line) if m == mark}
        for mark in "o#"
    }
    front, body = (middle(cells[mark]) for mark in "o#")
    ahead = front[0] - body[0], 2 * (front[1] - body[1])
    assert ahead[0] * nose[0] + ahead[1] * nose[1] > 8


def test_a_tank_has_two_wheels_that_do_not_steer(tank):
    assert draw(tank, steering=0.0) == draw(tank, steering=0.4)


def test_its_length_follows_from_its_wheelbase(car, tank):
    assert length_of(car) == pytest.approx(0.25 / 0.63)
    for wheelbase in (0.0, -1.0, float("nan"), float("inf")):
        tank.wheelbase = wheelbase
        assert length_of(tank) == length_of(None) == 0.35
