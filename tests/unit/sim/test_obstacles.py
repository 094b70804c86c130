from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.sim.obstacles import RUN, Obstacles, Side, away, clearance
from zteleop.sim.scene import Box, Post, Scene, Wall

WALL = Side(0.0, 0.0, 2.0, 0.0, 0.0, 0.25, "walls[0]")
POST = Side(1.0, 1.0, 0.0, 0.0, 0.5, 0.0, "posts[0]")
SCENE = Scene(
    walls=[Wall([(0, 0), (4, 0), (4, 3)]), Wall([(10, 10), (11, 10), (11, 11)], closed=True)],
    posts=[Post((1, 1), radius=0.5)],
    boxes=[Box((-3, 0), (2, 2))],
)


@pytest.mark.parametrize(
    ("x", "y", "expected"), [(1, 0.5, (0, 0.5)), (-1, 0, (-1, 0)), (3, -1, (1, -1)), (0.5, 0, (0, 0))]
)
def test_the_way_from_a_wall_leads_from_its_nearest_place(
    x: float, y: float, expected: tuple[float, float]
) -> None:
    assert away(WALL, x, y) == pytest.approx(expected)


def test_a_post_is_as_near_as_its_skin() -> None:
    assert clearance(POST, 3.0, 1.0) == pytest.approx(1.5)
    assert clearance(POST, 1.0, 1.2) == pytest.approx(-0.3)
    assert clearance(WALL, 1.0, 0.7) == pytest.approx(0.7)


def test_every_thing_has_its_sides_and_its_name() -> None:
    sides = Obstacles(SCENE).near(0, 0, 100)
    names = [side.name for side in sides]
    assert {name: names.count(name) for name in names} == {
        "walls[0]": 2,
        "walls[1]": 3,
        "boxes[0]": 4,
        "posts[0]": 1,
    }


def test_far_things_are_left_out() -> None:
    assert {side.name for side in Obstacles(SCENE).near(10.5, 10.5, 1.0)} == {"walls[1]"}
    assert Obstacles(Scene()).near(0, 0, 100) == []


@given(st.floats(-5, 15), st.floats(-5, 15), st.floats(0, 5))
def test_what_is_within_reach_is_never_left_out(x: float, y: float, reach: float) -> None:
    obstacles = Obstacles(SCENE)
    near = obstacles.near(x, y, reach)
    assert all(clearance(s, x, y) > reach for s in obstacles.near(x, y, 1000) if s not in near)


def test_a_long_wall_is_cut_into_runs_that_hold_it() -> None:
    wall = Wall([(at / 10, at % 2) for at in range(100)])
    obstacles = Obstacles(Scene(walls=[wall]))
    assert [len(run.sides) for run in obstacles.runs] == [RUN] * 12 + [3]
    for run in obstacles.runs:
        assert all(hypot(s.x - run.x, s.y - run.y) <= run.radius + 1e-9 for s in run.sides)


@pytest.mark.parametrize(("x", "y", "name"), [(-3, 0, "boxes[0]"), (0, 0, None), (10.8, 10.2, None)])
def test_boxes_are_filled_and_rooms_are_not(x: float, y: float, name: str | None) -> None:
    assert Obstacles(SCENE).filled(x, y) == name
