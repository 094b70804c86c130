"""A scene as lines: from where its robot starts, as text, and no more than can be drawn."""

import json

import pytest

from zteleop.cli._scenes import find, names
from zteleop.errors import ConfigError
from zteleop.sim.plan import LONGEST, MOST_POINTS, Trace, from_text, plan, to_text
from zteleop.sim.scene import Box, Pose, Post, Scene, Tape, Wall


def test_a_scene_is_seen_from_where_its_robot_starts() -> None:
    scene = Scene(start=Pose(1.0, 2.0, 90.0), tapes=[Tape([(1.0, 2.0), (1.0, 5.0)], colour="yellow")])
    (trace,) = plan(scene)
    assert trace.colour == "yellow"
    assert trace.points == [pytest.approx((0.0, 0.0)), pytest.approx((3.0, 0.0))]


def test_what_is_closed_comes_back_to_its_first_point_and_all_kinds_are_there() -> None:
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
    things = {"walls": [Wall(corners, closed=True)], "posts": [Post((3.0, 0.0))], "boxes": [Box((5.0, 0.0))]}
    found = plan(Scene(**things))
    assert [trace.points[0] == trace.points[-1] for trace in found] == [True, True, True]
    assert [trace.colour for trace in found] == ["brown", "orange", "blue"]


@pytest.mark.parametrize("name", names())
def test_what_comes_along_is_said_and_read_again(name: str) -> None:
    lines = plan(find(name))
    found = from_text(to_text(lines))
    assert [trace.colour for trace in found] == [trace.colour for trace in lines]
    for read, meant in zip(found, lines, strict=True):
        for place, at in zip(read.points, meant.points, strict=True):
            assert place == pytest.approx(at, abs=0.006)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "a.a.a.a = 1",
        "[" * 100_000,
        '[{"points":[[0,0]],"colour":"red"}]',
        '[{"points":[[0,0],[1e308,0]],"colour":"red"}]',
        '[{"points":[[0,0],[1,0]],"colour":"mauve"}]',
        "x" * (LONGEST + 1),
        json.dumps([{"points": [[0, 0]] * length, "colour": "red"} for length in (MOST_POINTS, 2)]),
    ],
    ids=["nothing", "toml", "deep", "a point", "far", "colour", "long", "many points"],
)
def test_what_a_stranger_says_is_no_scene(text: str) -> None:
    with pytest.raises(ConfigError, match=r"not a scene|is not shown"):
        from_text(text)


def test_a_scene_too_large_to_be_drawn_is_left_out() -> None:
    many = [Trace([(0.0, 0.0)] * MOST_POINTS, "red"), Trace([(0.0, 0.0)] * 2, "red")]
    assert from_text(to_text(many)) == []
