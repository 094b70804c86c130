from math import cos, hypot, sin

import pytest

from zteleop.control.stick import Speeds, Stick, to_twist
from zteleop.inputs.script import Script


def place(vehicle, speeds, duration):
    """Drive the figure with perfect wheels; return the end and the farthest point on either side."""
    script = Script(duration, speeds)
    script.fit(vehicle)
    x = y = heading = 0.0
    sides = [0.0]
    script.read(0.0)
    for tick in range(int(duration * 100)):
        twist = to_twist(script.stick(tick / 100), script.speeds, vehicle)
        heading += twist.angular.z / 100
        x, y = x + twist.linear.x * cos(heading) / 100, y + twist.linear.x * sin(heading) / 100
        sides.append(y)
    return x, y, min(sides), max(sides)


def test_it_drives_an_eight_and_comes_back(car):
    x, y, right, left = place(car, Speeds(0.5, 1.0), 20.0)
    assert hypot(x, y) < 0.2
    assert left == pytest.approx(-right, abs=0.2)
    assert left > 1.0


def test_it_acts_at_every_read_until_it_is_done():
    script = Script(10.0)
    assert script.fileno() is None
    assert script.stick(5.0) == Stick()
    assert script.read(5.0)
    assert script.stick(5.0).deadman
    assert script.read(14.9)
    assert not script.read(15.0)
    assert script.finished
    assert script.stick(15.0) == Stick()


def test_it_wishes_for_no_stop():
    script = Script(10.0)
    script.read(0.0)
    assert script.wish is None


def test_a_reset_is_neutral_and_begins_anew():
    script = Script(10.0)
    script.read(0.0)
    script.reset(9.0)
    assert script.stick(9.0) == Stick()
    assert script.read(12.0)
    assert script.read(21.0)


def test_a_vehicle_that_cannot_turn_goes_straight(tank):
    tank.max_turn = 0.0
    with Script() as script:
        script.fit(tank)
        script.read(0.0)
        assert script.stick(1.0) == Stick(1.0, 0.0, True)
    assert script.finished
