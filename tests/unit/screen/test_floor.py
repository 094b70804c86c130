import pytest

from zteleop.cli._scenes import find
from zteleop.screen.floor import marks
from zteleop.sim.scene import Box, Pose, Post, Scene, Tape, Wall


def test_a_scene_is_seen_from_where_its_robot_starts() -> None:
    scene = Scene(start=Pose(1.0, 2.0, 90.0), tapes=[Tape([(1.0, 2.0), (1.0, 5.0)], colour="yellow")])
    (mark,) = marks(scene)
    assert mark.style == "yellow"
    assert mark.points == [pytest.approx((0.0, 0.0)), pytest.approx((3.0, 0.0))]


def test_what_is_closed_comes_back_to_its_first_point_and_all_kinds_are_shown() -> None:
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
    things = {"walls": [Wall(corners, closed=True)], "posts": [Post((3.0, 0.0))], "boxes": [Box((5.0, 0.0))]}
    found = marks(Scene(**things))
    assert [mark.points[0] == mark.points[-1] for mark in found] == [True, True, True]
    assert [mark.style for mark in found] == ["", "red", ""]


def test_a_demo_has_a_line_ahead_and_two_cones() -> None:
    found = marks(find("eight")[0])
    assert sorted(mark.style for mark in found) == ["red", "red", "yellow", "yellow"]
    ahead = [
        point for mark in found if mark.style == "yellow" for point in mark.points if abs(point[1]) < 0.05
    ]
    assert max(x for x, _ in ahead) > 0.1
