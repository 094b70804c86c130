from itertools import pairwise
from math import isfinite

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from zteleop.messages import Header, Time
from zteleop.sim.battery import LITHIUM_ION, Battery, BatterySettings

CAR = BatterySettings()
CREATE3 = BatterySettings(
    cells=4,
    energy_wh=26.0,
    nominal_voltage=14.4,
    empty_voltage=12.0,
    full_voltage=16.8,
    resistance=0.15,
    technology=LITHIUM_ION,
)
HEADER = Header(Time(1, 2), "base_link")
PACKS = pytest.mark.parametrize("settings", [CAR, CREATE3])


@PACKS
def test_its_voltage_runs_from_full_to_empty(settings: BatterySettings) -> None:
    volts = [Battery(replace(settings, percentage=percent / 100)).voltage for percent in range(101)]
    assert (volts[0], volts[-1]) == pytest.approx((settings.empty_voltage, settings.full_voltage))
    assert all(low < high for low, high in pairwise(volts))
    assert volts[50] == pytest.approx(settings.nominal_voltage, rel=0.05)


@PACKS
def test_it_gives_about_the_energy_it_is_said_to_hold(settings: BatterySettings) -> None:
    battery, watts = Battery(settings), settings.energy_wh / 5
    hours = 0.0
    while battery.percentage > 0:
        battery.draw(watts, 10.0)
        hours += 10 / 3600
    assert hours * watts == pytest.approx(settings.energy_wh, rel=0.06)


def test_under_a_load_its_voltage_gives_way() -> None:
    battery = Battery(CAR)
    battery.draw(40.0, 0.01)
    assert battery.current == pytest.approx(-4.87, abs=0.01)
    assert battery.voltage == pytest.approx(8.4 - 4.87 * 0.04, abs=0.001)
    assert battery.voltage * battery.current == pytest.approx(-40.0)


def test_it_gives_no_more_than_its_resistance_allows() -> None:
    battery = Battery(CAR)
    battery.draw(1e6, 0.01)
    assert battery.current == pytest.approx(-8.4 / 0.08)


def test_on_a_charger_it_fills_up_and_is_full() -> None:
    battery = Battery(replace(CREATE3, percentage=0.5))
    battery.charge(20.0, 1.0)
    assert battery.current > 0
    assert battery.voltage > Battery(replace(CREATE3, percentage=0.5)).voltage
    assert battery.state(HEADER).power_supply_status == 1
    for _ in range(5000):
        battery.charge(20.0, 1.0)
    assert (battery.percentage, battery.current, battery.state(HEADER).power_supply_status) == (1.0, 0.0, 4)


def test_a_charger_without_power_does_not_charge() -> None:
    battery = Battery(replace(CAR, percentage=0.5))
    battery.charge(0.0, 1.0)
    assert battery.state(HEADER).power_supply_status == 3


def test_an_empty_one_gives_nothing() -> None:
    battery = Battery(replace(CAR, percentage=0.0))
    battery.draw(40.0, 1.0)
    assert (battery.current, battery.percentage, battery.strength) == (0.0, 0.0, 0.0)


def test_its_strength_follows_the_voltage_below_the_nominal_one() -> None:
    full, low = Battery(CAR), Battery(replace(CAR, percentage=0.05))
    assert full.strength == 1.0
    assert low.strength == pytest.approx(6.84 / 7.4)
    low.draw(30.0, 0.01)
    assert low.strength < 6.84 / 7.4


def test_it_tells_what_ros_asks_for() -> None:
    battery = Battery(replace(CAR, percentage=0.5))
    battery.draw(10.0, 0.01)
    state = battery.state(HEADER)
    assert state.header == HEADER
    assert (state.voltage, state.current) == (battery.voltage, battery.current)
    assert state.percentage == pytest.approx(0.5, abs=1e-5)
    assert (state.charge, state.capacity) == pytest.approx((2.5, 5.0), abs=1e-5)
    assert (state.power_supply_status, state.power_supply_technology, state.present) == (2, 3, True)
    assert state.cell_voltage == [pytest.approx(battery.voltage / 2)] * 2


def test_a_pack_emptier_when_it_is_full_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^empty_voltage must lie below full_voltage, found 9 and 8\.4$"):
        BatterySettings(empty_voltage=9.0)


@given(
    st.lists(st.tuples(st.booleans(), st.floats(0, 1e6), st.floats(1e-6, 1.0)), max_size=30), st.floats(0, 1)
)
def test_whatever_goes_in_and_out_it_stays_a_battery(
    acts: list[tuple[bool, float, float]], percentage: float
) -> None:
    battery = Battery(replace(CAR, percentage=percentage))
    for charges, watts, dt in acts:
        (battery.charge if charges else battery.draw)(watts, dt)
        assert 0 <= battery.percentage <= 1
        assert isfinite(battery.voltage)
        assert isfinite(battery.current)
        assert 0 <= battery.strength <= 1
        assert battery.current >= 0 if charges else battery.current <= 0
