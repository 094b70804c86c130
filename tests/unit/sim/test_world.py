"""A body in a scene: what it runs into, from where it may go, and what it sees."""

from math import pi

import pytest

from zteleop.control.mixer import Differential
from zteleop.control.motion.pose import Pose2D
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.errors import ConfigError
from zteleop.sim import make_vehicle
from zteleop.sim.body import Disc
from zteleop.sim.scene import Box, Pose, Post, Scene, Wall
from zteleop.sim.tank import Tank
from zteleop.sim.world import Contact, World

ROUND = (Disc(0.0, 0.2),)
LONG = (Disc(0.0, 0.1), Disc(0.4, 0.1))
WALL = Wall([(1.0, -1.0), (1.0, 1.0)])
HERE = Pose2D()


def world(discs: tuple[Disc, ...] = ROUND, start: Pose | None = None, **things: object) -> World:
    return World(Scene(start=start or Pose(), **things), discs)  # type: ignore[arg-type]


def test_on_a_floor_without_end_nothing_is_in_the_way() -> None:
    floor = world()
    assert floor.admits(HERE, Pose2D(500.0, 3.0, 1.0))
    assert (floor.contacts, floor.is_floor(1.0, 1.0), floor.dock()) == ([], True, None)
    assert floor.distance(0.0, 0.0, 0.0, 4.0) == 4.0


def test_a_wall_stops_it_at_its_edge_and_it_may_go_back() -> None:
    room = world(walls=[WALL])
    assert room.admits(HERE, near := Pose2D(0.79))
    assert not room.admits(near, Pose2D(0.81))
    assert room.contact == Contact("walls[0]", 0.0)
    assert room.contacts == [0.0]
    assert room.admits(near, near), "whoever stands moves nowhere"
    assert room.contacts == [0.0], "and still stands there"
    assert room.admits(near, Pose2D(0.7))
    assert room.contacts == []


def test_it_slides_along_what_it_does_not_touch() -> None:
    room = world(walls=[WALL])
    assert room.admits(Pose2D(0.79, 0.0), Pose2D(0.79, 0.3))


def test_what_is_in_something_already_may_come_out_and_not_go_deeper() -> None:
    room = world(walls=[WALL])
    assert not room.admits(Pose2D(0.85), Pose2D(0.86))
    assert room.admits(Pose2D(0.85), Pose2D(0.84))


@pytest.mark.parametrize(("heading_deg", "turned"), [(0.0, 0.0), (90.0, -pi / 2), (180.0, pi)])
def test_poses_of_the_odometry_begin_where_the_scene_starts(heading_deg: float, turned: float) -> None:
    room = world(start=Pose(0.5, 0.0, heading_deg), walls=[WALL])
    before, after = (HERE.ahead(0.0, 0.0, turned).ahead(way) for way in (0.29, 0.31))
    assert not room.admits(Pose2D(*before[:2]), Pose2D(*after[:2]))
    assert abs(room.contacts[0]) == pytest.approx(abs(turned)), "seen from a body that looks as at the start"


def test_every_part_of_a_body_runs_into_things() -> None:
    room = world(LONG, posts=[Post((0.9, 0.0), radius=0.1)])
    assert room.admits(HERE, Pose2D(0.29))
    assert not room.admits(Pose2D(0.29), Pose2D(0.31))
    assert room.contact == Contact("posts[0]", 0.0)
    aside = world(LONG, walls=[Wall([(-1.0, 0.3), (1.0, 0.3)])])
    assert not aside.admits(Pose2D(0.0, 0.0, 0.4), Pose2D(0.0, 0.0, 0.6)), "its nose swings into the wall"
    assert aside.contacts == [pytest.approx(pi / 2 - 0.6)]


def test_a_drop_stops_it_at_the_edge_and_is_no_floor() -> None:
    stairs = world(drops=[[(1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0)]])
    assert not stairs.admits(Pose2D(0.99), Pose2D(1.01))
    assert (stairs.contact, stairs.contacts) == (Contact("drops[0]", None), [])
    assert stairs.admits(Pose2D(0.99), Pose2D(0.9))
    assert (stairs.is_floor(0.0, 0.0), stairs.is_floor(0.2, 0.0)) == (True, False)
    assert stairs.admits(Pose2D(1.05), Pose2D(1.03)), "back from over it"


def test_it_sees_from_where_it_is() -> None:
    room = world(walls=[WALL])
    room.admits(HERE, Pose2D(0.5, 0.2))
    assert room.distance(0.1, 0.0, 0.0, 4.0) == pytest.approx(0.4)
    room.admits(Pose2D(0.5, 0.2), Pose2D(0.5, 0.2, pi / 2))
    assert room.distance(0.0, 0.0, -pi / 2, 4.0) == pytest.approx(0.5)


def test_far_things_are_met_when_it_comes_there() -> None:
    room = world(posts=[Post((50.0, 0.0), radius=0.1)])
    at = HERE
    while room.admits(at, after := at.ahead(0.1)):
        at = after
    assert at.x == pytest.approx(49.7, abs=0.11)


def test_a_dock_is_seen_from_the_body() -> None:
    room = world(start=Pose(1.0, 1.0, 90.0), dock=Pose(1.0, 2.0, 180.0))
    assert room.dock() == pytest.approx((1.0, 0.0, pi / 2))


@pytest.mark.parametrize(
    ("things", "name"),
    [
        ({"boxes": [Box((0.0, 0.0), (2.0, 2.0))]}, r"boxes\[0\]"),
        ({"walls": [Wall([(0.1, -1.0), (0.1, 1.0)])]}, r"walls\[0\]"),
    ],
)
def test_a_scene_without_room_at_its_start_is_refused(things: dict[str, object], name: str) -> None:
    with pytest.raises(ConfigError, match=f"a robot does not fit where the scene starts: {name} is there"):
        world(**things)


def test_a_car_stands_before_a_wall_however_long_it_pushes_and_backs_away() -> None:
    settings = DriveSettings()
    car = make_vehicle(settings.mixer, settings.servos)
    room = car.room = World(Scene(walls=[WALL]), car.discs)
    throttle, steering = settings.servos["throttle"], settings.servos["steering"]
    full, back = (
        {throttle.channel: throttle.pulse_us(share), steering.channel: steering.pulse_us(0.0)}
        for share in (1.0, -1.0)
    )
    car.step(full, 1.0)
    for _ in range(3):
        car.step(full, 1.0)
        assert (car.speed, car.yaw_rate) == (0.0, 0.0)
    assert 0.0 <= 1.0 - room.nose - car.x < 0.04
    stood = car.x
    car.step(back, 0.5)
    assert car.x < stood
    assert room.contact is None


def test_a_tank_that_pushes_a_wall_stands_with_both_wheels() -> None:
    servos = {"left": Servo(0), "right": Servo(1)}
    tank = make_vehicle(Differential(), servos)
    tank.room = World(Scene(walls=[WALL]), tank.discs)
    tank.step({0: servos["left"].pulse_us(1.0), 1: servos["right"].pulse_us(1.0)}, 1.0)
    tank.step({0: servos["left"].pulse_us(1.0), 1: servos["right"].pulse_us(1.0)}, 1.0)
    assert isinstance(tank, Tank)
    assert tank.wheel_speeds == (0.0, 0.0)


def test_whoever_pushes_on_is_told_again_once_somebody_has_looked() -> None:
    room = world(walls=[WALL])
    room.admits(HERE, near := Pose2D(0.79))
    assert not room.pushed
    room.admits(near, Pose2D(0.81))
    assert room.pushed
    room.pushed = False
    room.admits(near, near)
    assert not room.pushed, "it stands, and wants nothing"
    room.admits(near, Pose2D(0.81))
    assert room.pushed
