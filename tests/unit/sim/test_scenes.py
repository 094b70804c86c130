"""The scenes that come along."""

import re
from itertools import pairwise
from math import atan2, dist, remainder, tau
from pathlib import Path

import pytest

from zteleop.control.settings import DriveSettings
from zteleop.sim import make_vehicle, outline
from zteleop.sim.obstacles import Obstacles, clearance
from zteleop.sim.scene import Scene, parse
from zteleop.sim.world import World

SCENES = {
    path.stem: parse(path.read_bytes()) for path in Path(outline.__file__).with_name("scenes").iterdir()
}
ROOM = 0.25
"""m around the middle of any robot"""


def room(scene: Scene, x: float, y: float) -> float:
    return min((clearance(side, x, y) for side in Obstacles(scene).near(x, y, 2.0)), default=2.0)


def test_the_simplest_is_a_floor_without_end() -> None:
    assert sorted(SCENES) == ["classroom", "eight", "floor", "maze", "track"]
    assert SCENES["floor"] == Scene()


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_every_robot_has_room_at_the_start_and_on_the_dock_of_each(scene: Scene) -> None:
    assert room(scene, scene.start.x, scene.start.y) > ROOM
    assert Obstacles(scene).filled(scene.start.x, scene.start.y) is None
    if scene.dock:
        assert room(scene, scene.dock.x, scene.dock.y) > 0.17


def test_the_classroom_has_a_grid_of_half_metres_and_a_circle_to_start_on() -> None:
    scene = SCENES["classroom"]
    circle = next(tape for tape in scene.tapes if len(tape.points) > 40)
    assert [dist(point, (2.5, 2.5)) for point in circle.points] == pytest.approx([0.5] * len(circle.points))
    assert dist((scene.start.x, scene.start.y), (2.5, 2.5)) == 0.5
    ends = {round(value, 3) for tape in scene.tapes[:3] for point in tape.points for value in point}
    assert ends == {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}


def test_the_line_of_the_track_is_smooth_and_well_off_the_walls() -> None:
    track = SCENES["track"]
    line = track.tapes[0]
    ends = list(outline.sides(line.points, closed=True))
    assert line.closed
    assert sum(dist(*end) for end in ends) == pytest.approx(22.3, abs=0.1)
    for (a, b), (c, d) in pairwise([*ends, ends[0]]):
        turn = abs(remainder(atan2(d[1] - c[1], d[0] - c[0]) - atan2(b[1] - a[1], b[0] - a[0]), tau))
        chord = min(dist(a, b), dist(c, d))
        assert turn <= chord / 0.8 * 1.01
    sides = Obstacles(track).near(0, 0, 100)
    assert min(clearance(side, *point) for side in sides for point in line.points) > 0.6
    assert track.start.y == 0.0


def test_the_eight_starts_on_both_its_rounds_and_has_a_cone_in_each() -> None:
    eight = SCENES["eight"]
    for tape, cone in zip(eight.tapes, eight.posts, strict=True):
        assert [dist(point, cone.at) for point in tape.points] == pytest.approx(
            [1.0] * len(tape.points), abs=1e-6
        )
        assert dist((eight.start.x, eight.start.y), cone.at) == 1.0


def test_the_page_tells_of_each_scene_and_its_own_can_be_driven_in() -> None:
    page = (Path(__file__).parents[3] / "docs/simulation.md").read_text()
    assert set(re.findall(r"^\| `([a-z]+)` \|", page, re.MULTILINE)) >= set(SCENES)
    text = page[page.index('    floor = "grey"') : page.index("| key | of |")]
    scene = parse("\n".join(line[4:] for line in text.splitlines()).encode())
    assert (len(scene.walls), len(scene.boxes), len(scene.posts), len(scene.tapes)) == (1, 1, 1, 1)
    settings = DriveSettings()
    World(scene, make_vehicle(settings.mixer, settings.servos).discs)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_a_car_fits_where_each_begins(scene: Scene) -> None:
    settings = DriveSettings()
    World(scene, make_vehicle(settings.mixer, settings.servos).discs)
