import json
from contextlib import suppress
from math import hypot, radians

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import ConfigError
from zteleop.sim import scene
from zteleop.sim.scene import Box, Post, Scene, Wall, parse


def test_nothing_is_a_floor_without_end() -> None:
    assert parse(b"") == Scene()


def test_all_that_a_scene_can_hold() -> None:
    found = parse(b"""
floor = "white"
start = { x = 1, y = 2.5, heading_deg = 90 }
dock = { x = 3 }
drops = [[[5, 5], [6, 5], [6, 6]]]
walls = [{ points = [[0, 0], [1, 0]], height = 2.0, colour = "red" }]
tapes = [{ points = [[0, 0], [1, 0], [1, 1]], closed = true, width = 0.1 }]
posts = [{ at = [2, 2], radius = 0.5 }]
boxes = [{ at = [3, 3], size = [2, 1], heading_deg = 90 }]
""")
    assert (found.floor, found.start.y, found.start.heading) == ("white", 2.5, radians(90))
    assert found.dock is not None
    assert found.dock.x == 3.0
    assert (found.walls[0].height, found.tapes[0].closed, found.posts[0].radius) == (2.0, True, 0.5)
    assert found.drops == [[(5.0, 5.0), (6.0, 5.0), (6.0, 6.0)]]


def test_a_bend_is_laid_out_at_once_and_not_twice() -> None:
    (tape,) = parse(b"[[tapes]]\npoints=[[-1,-1],[1,-1],[1,1],[-1,1]]\nclosed=true\nbend=1").tapes
    assert [hypot(x, y) for x, y in tape.points] == pytest.approx([1.0] * 48)
    assert (tape.bend, tape.closed) == (0.0, True)


def test_a_box_knows_its_corners() -> None:
    box = Box((1.0, 2.0), (4.0, 2.0), heading_deg=90)
    assert {(round(x, 9), round(y, 9)) for x, y in box.corners} == {(0, 0), (2, 0), (2, 4), (0, 4)}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("wals = []", r"^no key 'wals'; did you mean walls\?$"),
        ("[start]\nhaeding_deg = 1", r"^start: no key 'haeding_deg'; did you mean heading_deg\?$"),
        ("posts = [{ at = [0, 0], radios = 1 }]", r"^posts\[0\]: no key 'radios'; did you mean radius\?$"),
        ("floor = 'gray'", r"^floor: no colour 'gray'; did you mean grey\?$"),
        ("walls = [{ points = [[0, 0]] }]", r"^walls\[0\]\.points: Expected `array` of length >= 2$"),
        (
            "walls = [{ points = [[0, 0], [1]] }]",
            r"^walls\[0\]\.points\[1\]: Expected `array` of length 2, got 1$",
        ),
        (
            "walls = [{ points = [[0, 0], [0, 0]] }]",
            r"^walls\[0\]: points\[0\] and points\[1\] are one place",
        ),
        (
            "tapes = [{ points = [[0, 0], [1, 0], [1, 1]], bend = 5 }]",
            r"^tapes\[0\]: a bend of 5 m needs 5 m",
        ),
        ("tapes = [{ points = [[0, 0], [1, 0]], width = 0 }]", r"^tapes\[0\]\.width: Expected `float` > 0"),
        ("posts = [{ at = [0, 1e9] }]", r"^posts\[0\]\.at\[1\]: Expected `float` <= 1000"),
        ("posts = [{ at = [0, nan] }]", r"^posts\[0\]\.at\[1\]: Expected `float`"),
        ("start = { x = inf }", r"^start\.x: Expected `float` <= 1000"),
        (f"start = {{ x = 1{'0' * 400} }}", "."),
        ("boxes = [{ size = [1, 1] }]", r"^boxes\[0\]: Object missing required field `at`$"),
        ("drops = [[[0, 0], [1, 1], [2, 2]]]", r"^drops\[0\] encloses no floor"),
        ("drops = [[[5, 0], [5, 0], [6, 2]]]", r"^drops\[0\]: points\[0\] and points\[1\] are one place"),
        ("drops = [[[-1, -1], [1, -1], [0, 1]]]", r"^the start lies in drops\[0\]"),
        ("x = ", "^not TOML: "),
        ("a = " + "[" * 10_000, "^not TOML: "),
    ],
)
def test_a_mistake_is_told_with_its_place_and_the_reason(text: str, why: str) -> None:
    with pytest.raises(ConfigError, match=why) as error:
        parse(text.encode())
    assert "\n" not in str(error.value)


def test_what_is_no_text_is_no_scene() -> None:
    with pytest.raises(ConfigError, match="not TOML"):
        parse(b"\xff\xfe")


def test_a_huge_scene_is_refused_by_its_size_and_by_its_sides() -> None:
    with pytest.raises(ConfigError, match="at most 1048576 bytes"):
        parse(b"#" * (scene.LONGEST + 1))
    zigzag = ", ".join(f"[{at % 2}, {at / 2}]" for at in range(1000))
    text = "\n".join(f"[[walls]]\npoints = [{zigzag}]" for _ in range(11))
    with pytest.raises(ConfigError, match="at most 10000 straight sides in all, found 11000"):
        parse(text.encode())


def test_boxes_and_drops_count_too() -> None:
    walls = [Wall([(at, 0), (at, 1), (at, 2)]) for at in range(999)]
    boxes = [Box((at, 5)) for at in range(1000)]
    with pytest.raises(ValueError, match="at most 10000 straight sides in all, found 10006"):
        Scene(
            walls=walls,
            boxes=boxes,
            tapes=walls[:3],
            drops=[[(at, 9), (at + 1, 9), (at, 8)] for at in range(1000)],
        )


KEYS = st.sampled_from(
    ["floor", "start", "dock", "walls", "tapes", "posts", "boxes", "drops", "points", "at", "x"]
)
VALUES = st.recursive(
    st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=12,
)


@given(st.binary(max_size=200) | st.text(max_size=200).map(str.encode))
def test_any_bytes_are_a_scene_or_a_config_error(text: bytes) -> None:
    with suppress(ConfigError):
        assert isinstance(parse(text), Scene)


@given(st.dictionaries(KEYS, VALUES, max_size=4))
def test_any_values_are_a_scene_or_a_config_error(values: dict[str, object]) -> None:
    with suppress(ConfigError):
        assert isinstance(
            parse("\n".join(f"{key} = {toml(item)}" for key, item in values.items()).encode()), Scene
        )


def toml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return str(value).lower() if isinstance(value, bool | float | int) else json.dumps(value)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("posts[1]", "the red post"),
        ("walls[0]", "the brown wall"),
        ("boxes[0]", "the blue box"),
        ("drops[0]", "the edge of the floor"),
    ],
)
def test_a_part_of_a_scene_is_called_by_its_colour_and_kind(name: str, words: str) -> None:
    corners = [(0.5, 0.5), (1.0, 0.5), (1.0, 1.0)]
    posts = [Post((2.0, 0.0)), Post((3.0, 0.0), colour="red")]
    scene = Scene(walls=[Wall(corners)], posts=posts, boxes=[Box((5.0, 0.0))], drops=[corners])
    assert scene.called(name) == words
