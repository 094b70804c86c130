"""What a camera sees of a scene, in pixels."""

from math import atan, degrees, pi, radians, tan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.motion.pose import Pose2D
from zteleop.sim.camera import NOTHING, PAINTS, Camera, Lens
from zteleop.sim.scene import Box, Post, Scene, Tape, Wall

LENS = Lens()
LEVEL = LENS._replace(tilt=0.0)
HERE = Pose2D()


def seen(
    scene: Scene, pose: Pose2D = HERE, lens: Lens = LENS
) -> list[tuple[list[tuple[float, float]], object]]:
    return [(polygon.points, polygon.colour) for polygon in Camera(scene, lens).look(pose)]


def spread(points: list[tuple[float, float]]) -> tuple[float, float, float, float]:
    us, vs = [u for u, _ in points], [v for _, v in points]
    return min(us), max(us), min(vs), max(vs)


def test_the_horizon_is_as_high_as_the_camera_looks_down() -> None:
    assert LEVEL.horizon == LENS.height / 2
    below = (LENS.height / 2 - LENS.horizon) / LENS.focal
    assert degrees(atan(below)) == pytest.approx(15)


def test_the_edge_of_the_picture_is_the_edge_of_the_field_of_view() -> None:
    far = 4.0
    aside = far * tan(LENS.field_of_view / 2)
    wall = Wall(points=[(LENS.ahead + far, aside), (LENS.ahead + far, -aside)])
    ((points, _),) = seen(Scene(walls=[wall]), lens=LEVEL)
    left, right, _, _ = spread(points)
    assert (left, right) == (pytest.approx(0, abs=1e-6), pytest.approx(LENS.width))


def test_what_is_on_the_left_is_on_the_left_and_what_is_low_is_below_the_horizon() -> None:
    ((points, colour),) = seen(Scene(tapes=[Tape(points=[(1.0, 0.5), (2.0, 0.5)], colour="yellow")]))
    _, right, top, _ = spread(points)
    assert right < LENS.width / 2
    assert top > LENS.horizon
    assert colour == PAINTS["yellow"]


def test_a_wall_as_high_as_the_camera_ends_at_the_horizon() -> None:
    wall = Wall(points=[(2.0, 1.0), (2.0, -1.0)], height=LENS.above)
    ((points, _),) = seen(Scene(walls=[wall]), lens=LEVEL)
    assert spread(points)[2] == pytest.approx(LEVEL.horizon)


def test_what_is_nearer_is_drawn_later() -> None:
    walls = [Wall(points=[(x, 1.0), (x, -1.0)], colour=colour) for x, colour in ((1.0, "red"), (3.0, "blue"))]
    assert [colour for _, colour in seen(Scene(walls=walls))] == [PAINTS["blue"], PAINTS["red"]]


def test_what_lies_on_the_floor_is_under_what_stands_on_it() -> None:
    scene = Scene(
        tapes=[Tape(points=[(0.5, 0.0), (3.0, 0.0)], colour="yellow")],
        boxes=[Box(at=(2.0, 0.0), colour="blue")],
        posts=[Post(at=(1.5, 0.5))],
        drops=[[(3.0, -1.0), (4.0, -1.0), (4.0, 1.0), (3.0, 1.0)]],
    )
    colours = [colour for _, colour in seen(scene)]
    assert colours[:2] == [NOTHING, PAINTS["yellow"]]
    assert PAINTS["blue"] in colours[2:]


def test_what_is_behind_or_far_away_is_not_drawn() -> None:
    wall = Wall(points=[(-2.0, 1.0), (-2.0, -1.0)])
    far = Wall(points=[(20.0, 1.0), (20.0, -1.0)])
    assert seen(Scene(walls=[wall, far])) == []
    assert len(seen(Scene(walls=[wall]), Pose2D(0.0, 0.0, pi))) == 1


@pytest.mark.parametrize("side", [1, -1])
def test_what_is_beside_the_picture_is_not_drawn(side: int) -> None:
    assert seen(Scene(walls=[Wall(points=[(1.0, 2.0 * side), (1.0, 3.0 * side)])])) == []


def test_a_line_that_begins_behind_the_camera_reaches_the_lower_edge() -> None:
    ((points, _),) = seen(Scene(tapes=[Tape(points=[(-5.0, 0.0), (5.0, 0.0)])]))
    _, _, top, bottom = spread(points)
    assert bottom > LENS.height
    assert top > LENS.horizon


def test_it_sees_the_same_from_everywhere_when_everything_turns_with_it() -> None:
    here = seen(Scene(boxes=[Box(at=(2.0, 0.3))]))
    there = Pose2D(3.0, -1.0, radians(70)).ahead(2.0, 0.3)
    turned = Box(at=(there.x, there.y), heading_deg=70)
    again = seen(Scene(boxes=[turned]), Pose2D(3.0, -1.0, radians(70)))
    assert [spread(points) for points, _ in here] == [pytest.approx(spread(points)) for points, _ in again]


@given(
    st.floats(-3, 3),
    st.floats(-3, 3),
    st.floats(-pi, pi),
    st.lists(st.tuples(*[st.floats(-5, 5)] * 2), min_size=2, max_size=2, unique=True),
)
def test_no_place_is_projected_to_infinity(
    x: float, y: float, heading: float, points: list[tuple[float, float]]
) -> None:
    if abs(points[0][0] - points[1][0]) + abs(points[0][1] - points[1][1]) < 1e-3:
        return
    scene = Scene(walls=[Wall(points=points)], tapes=[Tape(points=points)], boxes=[Box(at=points[0])])
    for polygon, _ in seen(scene, Pose2D(x, y, heading)):
        assert len(polygon) >= 3
        assert all(abs(u) < 1e6 and abs(v) < 1e6 for u, v in polygon)
