from math import cos, inf, pi, radians, sin, sqrt
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.messages import Header, Time
from zteleop.sim import ranges
from zteleop.sim.obstacles import Obstacles
from zteleop.sim.ranges import RangeSensor
from zteleop.sim.scene import Box, Post, Scene, Wall

HEADER = Header(Time(1, 2), "range_link")
ROOM = Wall([(-2, -1), (4, -1), (4, 1), (-2, 1)], closed=True)


def look(scene: Scene, bearing: float, x: float = 0.0, y: float = 0.0, longest: float = 100.0) -> float:
    return ranges.distance(Obstacles(scene).runs, x, y, bearing, longest)


@pytest.mark.parametrize(("bearing", "far"), [(0, 4), (pi, 2), (pi / 2, 1), (-pi / 2, 1), (pi / 4, sqrt(2))])
def test_a_room_is_seen_from_within(bearing: float, far: float) -> None:
    assert look(Scene(walls=[ROOM]), bearing) == pytest.approx(far)


def test_nothing_is_as_far_as_one_sees() -> None:
    assert look(Scene(), 0.0, longest=3.5) == 3.5
    assert look(Scene(walls=[ROOM]), 0.0, longest=3.5) == 3.5
    assert look(Scene(walls=[Wall([(-1, -1), (-1, 1)])]), 0.0) == 100.0


def test_the_nearest_of_several_counts() -> None:
    scene = Scene(walls=[ROOM], posts=[Post((2, 0), radius=0.5)], boxes=[Box((3, 0), (0.5, 0.5))])
    assert look(scene, 0.0) == pytest.approx(1.5)
    assert look(scene, 0.0, x=2.6) == pytest.approx(0.15)
    assert look(scene, pi, x=2.6) == pytest.approx(0.1)


def test_a_ray_passes_beside_a_post() -> None:
    assert look(Scene(posts=[Post((2, 0.6), radius=0.5)]), 0.0) == 100.0
    assert look(Scene(posts=[Post((2, 0.3), radius=0.5)]), 0.0) == pytest.approx(1.6)


def test_within_a_post_everything_is_near() -> None:
    assert look(Scene(posts=[Post((0, 0), radius=0.5)]), 0.0) == 0.0


def test_a_wall_seen_from_its_end_is_seen() -> None:
    along = Scene(walls=[Wall([(3, 0), (2, 0)])])
    assert look(along, 0.0) == 2.0
    assert look(along, pi) == 100.0
    assert look(along, 0.0, x=2.5) == 0.0
    assert look(along, 0.0, y=0.1) == 100.0


def test_what_lies_behind_is_not_seen() -> None:
    hook = Scene(walls=[Wall([(3, 0), (2, 0), (2, -9)])])
    assert look(hook, pi) == 100.0
    assert look(Scene(posts=[Post((-0.45, 0.4), radius=0.5)]), 0.0) == 100.0


def test_the_near_end_of_a_long_wall_is_seen_by_who_sees_a_little() -> None:
    assert look(Scene(walls=[Wall([(1.0, 0.0), (21.0, 20.0)])]), 0.0, y=0.5, longest=4.0) == pytest.approx(
        1.5
    )


@given(st.floats(-1.9, 3.9), st.floats(-0.9, 0.9), st.floats(-pi, pi))
def test_where_a_ray_ends_there_is_a_wall(x: float, y: float, bearing: float) -> None:
    far = look(Scene(walls=[ROOM]), bearing, x, y)
    end_x, end_y = x + far * cos(bearing), y + far * sin(bearing)
    assert min(abs(end_x + 2), abs(end_x - 4), abs(end_y - 1), abs(end_y + 1)) < 1e-6
    assert -2 - 1e-6 <= end_x <= 4 + 1e-6


class Cone:
    """Surroundings that are 1 m away where a ray looks a little to the left."""

    contacts = ()

    def is_floor(self, ahead: float, left: float) -> bool:
        return True

    def distance(self, ahead: float, left: float, bearing: float, longest: float) -> float:
        assert (ahead, left) == (0.3, 0.0)
        return 1.0 if bearing > 0.1 else longest

    def dock(self) -> None:
        return None


def test_a_sensor_tells_the_nearest_in_its_cone() -> None:
    assert RangeSensor().measure(Cone(), 0.3) == 1.0
    assert RangeSensor(field_of_view=radians(5)).measure(Cone(), 0.3) == 4.0


@pytest.mark.parametrize(("far", "told"), [(1.0, 1.0), (0.001, 0.02), (4.0, 4.0), (inf, 4.0)])
def test_a_reading_stays_within_what_the_sensor_can_tell(far: float, told: float) -> None:
    said = RangeSensor().state(HEADER, far, Random(1))
    assert (said.range, said.variance, said.min_range, said.max_range) == (told, 0.0, 0.02, 4.0)
    assert said.field_of_view == pytest.approx(0.26, abs=0.01)


def test_noise_is_on_what_is_seen_and_not_on_nothing() -> None:
    chance, sensor = Random(1), RangeSensor()
    said = [sensor.state(HEADER, 1.0, chance, 0.1).range for _ in range(500)]
    assert sum(said) / 500 == pytest.approx(1.0, abs=0.02)
    assert sum((value - 1) ** 2 for value in said) / 500 == pytest.approx(0.01, rel=0.2)
    assert sensor.state(HEADER, 4.0, chance, 0.1).range == 4.0
    assert sensor.state(HEADER, 1.0, chance, 0.1).variance == pytest.approx(0.01)
