from math import pi, radians

import pytest
from unit.sim.surroundings import Around

from zteleop.messages import Time
from zteleop.sim.create3.hazards import BUMP, CLIFF, CLIFFS, WHEEL_DROP, WHEELS, Hazard, Touch, touch

STAMP = Time(7, 8)


@pytest.mark.parametrize(
    ("degrees", "name"),
    [
        (-90, "bump_right"),
        (-60, "bump_right"),
        (-40, "bump_front_right"),
        (-10, "bump_front_center"),
        (10, "bump_front_center"),
        (40, "bump_front_left"),
        (60, "bump_left"),
        (90, "bump_left"),
    ],
)
def test_each_fifth_of_the_front_is_a_bumper(degrees: float, name: str) -> None:
    assert touch(Around([radians(degrees)])).hazards == [Hazard(BUMP, name)]


@pytest.mark.parametrize("degrees", [100, 180, -91])
def test_its_back_feels_nothing(degrees: float) -> None:
    assert touch(Around([radians(degrees)])).hazards == []


def test_two_contacts_on_one_bumper_are_one_hazard() -> None:
    felt = touch(Around([0.1, -0.1, 0.7]))
    assert felt.bumps == ("bump_front_center", "bump_front_left")


@pytest.mark.parametrize("name", CLIFFS)
def test_each_eye_sees_a_drop(name: str) -> None:
    assert touch(Around(holes=[CLIFFS[name]])).hazards == [Hazard(CLIFF, name)]


@pytest.mark.parametrize("name", WHEELS)
def test_a_wheel_without_floor_drops(name: str) -> None:
    assert touch(Around(holes=[WHEELS[name]])).hazards == [Hazard(WHEEL_DROP, name)]


def test_a_wall_is_against_who_goes_there_and_not_along_or_away() -> None:
    ahead, aside = Touch((0.0,)), Touch((pi / 2,))
    assert ahead.is_against(0.1)
    assert not ahead.is_against(-0.1)
    assert not ahead.is_against(0.0)
    assert Touch((pi,)).is_against(-0.1)
    assert not aside.is_against(0.1)
    assert not Touch().is_against(0.1)


def test_a_hazard_says_where_it_is_in_its_frame() -> None:
    said = Hazard(BUMP, "bump_left").message(STAMP)
    assert (said.type, said.header.frame_id, said.header.stamp) == (1, "bump_left", STAMP)
