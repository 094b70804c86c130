import pytest

from zteleop.control.mixer import Ackermann
from zteleop.control.settings import DONKEYCAR
from zteleop.control.vehicles import VEHICLES
from zteleop.nodes.battery import LOW, give_power
from zteleop.nodes.create3 import Equipment
from zteleop.sim import make_vehicle
from zteleop.sim.battery import Battery, BatterySettings
from zteleop.sim.car import Car
from zteleop.sim.create3.body import Create3
from zteleop.testing import Clock, FakeNode

FULL_THROTTLE = {0: DONKEYCAR["throttle"].max_us, 1: DONKEYCAR["steering"].neutral_us}


def drive(node: FakeNode, charge: float, seconds: int) -> Car:
    """Drive a car at full throttle, and return it."""
    car = Car(Ackermann(), DONKEYCAR)
    give_power(node, car, Battery(BatterySettings(percentage=charge)))
    node.loop.every(0.1, lambda: car.step(FULL_THROTTLE, 0.1))
    node.loop.live(seconds)
    return car


@pytest.fixture
def node(clock: Clock) -> FakeNode:
    return FakeNode(clock=clock)


def test_a_full_one_makes_full_speed_and_says_how_full_it_is(node: FakeNode) -> None:
    assert drive(node, 1.0, 5).speed == pytest.approx(Ackermann().max_speed, rel=0.01)
    told = node.said["battery_state"].messages
    assert len(told) == pytest.approx(5, abs=1)
    assert told[0].percentage > told[-1].percentage > 0.99
    assert node.warnings == []


def test_the_emptier_it_is_the_slower_the_car_and_at_last_it_stands(node: FakeNode) -> None:
    assert 1.0 < drive(node, LOW, 5).speed < 0.95 * Ackermann().max_speed
    (low,) = node.warnings
    assert low == "archangel's battery is low; start the simulator anew, without --charge, for a full one"
    node.warnings.clear()
    assert drive(node, 0.001, 20).speed == 0.0
    assert "archangel's battery is empty, and its motors stand" in node.warnings[-1]


def test_a_tank_with_half_of_its_voltage_is_half_as_fast() -> None:
    built = VEHICLES["tank"]
    tank = make_vehicle(built.mixer, built.servos)
    tank.power = 0.5
    full = {servo.channel: servo.max_us for servo in built.servos.values()}
    for _ in range(300):
        tank.step(full, 0.01)
    assert tank.speed == pytest.approx(built.mixer.max_speed / 2, rel=0.01)


def test_a_create3_begins_with_what_is_asked_for_too(node: FakeNode) -> None:
    Equipment(node, Create3(VEHICLES["create3"].servos), None, charge=0.2)
    node.loop.live(3)
    assert node.said["battery_state"].messages[0].percentage == pytest.approx(0.2, abs=0.01)


def test_it_runs_down_in_the_better_part_of_an_hour_at_full_speed(node: FakeNode) -> None:
    drive(node, 1.0, 60)
    first, last = (node.said["battery_state"].messages[at].percentage for at in (0, -1))
    assert 30 < 1 / (first - last) < 60
