from math import isfinite, nan

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.cap import (
    AT_EASE,
    GOOD_LATENCY,
    REFRESH,
    SLOT,
    SLOTS,
    WINDOW,
    Ages,
    Bound,
    Cap,
    CapSettings,
    Strain,
)
from zteleop.control.mux import Source

SOURCES = {
    "keyboard": Source(priority=90),
    "program": Source(priority=50, silence=0.5),
    "nav": Source(priority=10, max_speed=0.4),
}
TOP, SILENCE = 3.0, 0.3
WEAK, HOT = Strain(0.5, "undervoltage"), Strain(0.25, "heat")

latencies = st.floats(0, 1)
silences = st.floats(0.01, 1)
tops = st.floats(0.01, 1000)
rules = st.builds(CapSettings, st.none() | st.floats(0.1, 1000), st.floats(0.05, 100))


def cap(settings: CapSettings | None = None) -> Cap:
    return Cap(settings or CapSettings(), TOP, SOURCES)


def send(to: Cap, age: float, start: float = 10.0, count: int = 100, sender: int = 1) -> float:
    """Note commands of an age, 20 a second; return the time of the last."""
    for number in range(count):
        to.note("keyboard", sender, age, start + number / 20)
    return start + (count - 1) / 20


@given(rules, tops, latencies, latencies, silences)
def test_a_worse_link_is_never_faster(
    rule: CapSettings, top: float, one: float, other: float, silence: float
) -> None:
    better, worse = sorted((one, other))
    assert rule.speed(top, worse, silence) <= rule.speed(top, better, silence) * (1 + 1e-12)


@given(rules, tops, latencies, silences)
def test_a_cap_is_a_speed_and_never_above_the_vehicles(
    rule: CapSettings, top: float, latency: float, silence: float
) -> None:
    speed = rule.speed(top, latency, silence)
    assert isfinite(speed)
    assert 0 < speed <= top


@given(rules, tops, latencies, silences)
def test_within_the_cap_it_stops_within_the_distance_allowed(
    rule: CapSettings, top: float, latency: float, silence: float
) -> None:
    speed = rule.speed(top, latency, silence)
    allowed = rule.stopping_distance or rule.distance(top, GOOD_LATENCY, silence)
    assert rule.distance(speed, latency, silence) <= allowed * (1 + 1e-9)


@given(tops, silences, st.floats(0.1, 1000))
def test_a_distance_named_is_used_up_unless_the_vehicle_is_too_slow_for_it(
    top: float, silence: float, allowed: float
) -> None:
    rule = CapSettings(allowed)
    speed = rule.speed(top, 0.2, silence)
    assert speed == top or rule.distance(speed, 0.2, silence) == pytest.approx(allowed)


@given(tops, silences, st.floats(0, GOOD_LATENCY))
def test_a_good_link_costs_nothing(top: float, silence: float, latency: float) -> None:
    assert CapSettings().speed(top, latency, silence) == top


@pytest.mark.parametrize(
    ("latency", "speed"), [(0.05, 3.0), (0.15, 3.0), (0.2, 2.7), (0.25, 2.455), (0.3, 2.25)]
)
def test_the_default_car_as_the_docs_tell(latency: float, speed: float) -> None:
    assert CapSettings().speed(TOP, latency, SILENCE) == pytest.approx(speed, abs=0.001)


@pytest.mark.parametrize(
    ("latency", "speed"), [(0.05, 1.6), (0.15, 1.6), (0.2, 1.562), (0.25, 1.524), (0.3, 1.488)]
)
def test_two_metres_as_the_docs_tell(latency: float, speed: float) -> None:
    assert CapSettings(2.0).speed(TOP, latency, SILENCE) == pytest.approx(speed, abs=0.001)


@pytest.mark.parametrize(("count", "worst"), [(1, 1), (2, 1), (99, 1), (100, 2), (199, 2), (200, 3)])
def test_one_in_a_hundred_may_be_older_than_the_99th_percentile(count: int, worst: int) -> None:
    ages = Ages(1)
    for number in range(count):
        ages.note(number / 1000, number / 45)
    assert ages.p99(count / 45) == (count - worst) / 1000


def test_nothing_heard_is_no_age() -> None:
    assert Ages(1).p99(1.0) == 0.0


def test_an_age_counts_for_its_time_only() -> None:
    ages = Ages(1)
    ages.note(0.3, 1.0)
    assert ages.p99(1.0 + WINDOW) == 0.3
    assert ages.p99(1.01 + WINDOW) == 0.0


def test_a_flood_of_fresh_commands_pushes_no_late_one_out_and_takes_no_memory() -> None:
    ages = Ages(1)
    ages.note(0.3, 1.0)
    for number in range(5000):
        ages.note(0.01, 1.0 + number / 1000)
    assert len(ages._ages) == len(ages._times) <= SLOTS
    assert max(ages._ages) == 0.3
    assert SLOT * SLOTS >= WINDOW


def test_a_clock_that_goes_back_takes_no_memory_either() -> None:
    ages = Ages(1)
    for number in range(10_000):
        ages.note(0.1, 1000.0 - number)
    assert len(ages._ages) == len(ages._times) <= SLOTS
    assert ages.p99(1000.0) == 0.1


@pytest.mark.parametrize("late", [0.2, 0.3])
def test_the_cap_follows_the_link_down_and_up_again(late: float) -> None:
    found = cap()
    now = send(found, 0.05)
    assert found.find("keyboard", now) == Bound(TOP, "vehicle", pytest.approx(0.05))
    now = send(found, late, start=now + 0.05)
    bound = found.find("keyboard", now)
    assert (bound.by, bound.latency) == ("link", pytest.approx(late))
    assert bound.speed == CapSettings().speed(TOP, bound.latency, SILENCE)
    now = send(found, 0.05, start=now + 0.05, count=120)
    assert found.find("keyboard", now).speed == TOP


def test_all_ages_are_looked_at_five_times_a_second_only(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = []
    p99 = Ages.p99
    monkeypatch.setattr(Ages, "p99", lambda ages, now: looks.append(now) or p99(ages, now))
    found = cap()
    for number in range(200):
        now = 10 + number / 200
        found.note("keyboard", 1, 0.1, now)
        found.find("keyboard", now)
    assert len(looks) == round(1 / REFRESH)


def test_who_does_not_drive_slows_nobody_down() -> None:
    found = cap()
    found.note("program", 2, 0.3, 10.0)
    assert found.find("keyboard", 10.0) == Bound(TOP, "vehicle", 0.0)
    found.note("keyboard", 1, 0.05, 10.1)
    found.note_late("keyboard", 3, 0.3, 10.2)
    assert found.find("keyboard", 10.3).latency == 0.05


def test_another_sender_of_the_source_begins_with_a_link_of_its_own() -> None:
    found = cap()
    now = send(found, 0.3, sender=1)
    found.note("keyboard", 2, 0.05, now)
    assert found.find("keyboard", now).latency == 0.05


def test_what_came_too_late_counts_for_who_drove() -> None:
    found = cap()
    found.note_late("keyboard", 1, 0.3, 9.9)
    found.note("keyboard", 1, 0.05, 10.0)
    assert found.find("keyboard", 10.0).latency == 0.05
    found.note_late("keyboard", 1, 0.3, 10.1)
    assert found.find("keyboard", 10.3).latency == 0.3


def test_a_source_that_may_not_be_so_fast_anyway_keeps_its_own_bound() -> None:
    found = cap()
    found.note("nav", 1, 0.3, 10.0)
    assert found.find("nav", 10.0) == Bound(0.4, "source", 0.3)


def test_a_strain_takes_its_share_at_once_and_gives_it_back() -> None:
    found = cap()
    now = send(found, 0.05)
    assert found.find("keyboard", now).speed == TOP
    found.bear(WEAK)
    assert found.find("keyboard", now)[:2] == (1.5, "strain")
    assert found.rest() == Bound(1.5, "strain", 0.0)
    found.bear(HOT)
    assert found.find("keyboard", now).speed == 0.75
    found.bear(AT_EASE)
    assert found.find("keyboard", now).by == found.rest().by == "vehicle"


def test_of_link_and_strain_the_slower_counts() -> None:
    found = cap()
    found.note("keyboard", 1, 0.3, 10.0)
    found.bear(Strain(0.9, "a little"))
    assert found.find("keyboard", 10.0).by == "link"
    found.bear(WEAK)
    assert found.find("keyboard", 10.0)[:2] == (1.5, "strain")


@given(st.lists(st.tuples(st.floats(0, 0.3), st.floats(0, 100)), max_size=50), st.floats(0, 200))
def test_whatever_was_heard_and_whenever_nothing_is_raised(
    heard: list[tuple[float, float]], now: float
) -> None:
    found = cap()
    for age, at in heard:
        found.note("keyboard", 1, age, at)
        assert 0 < found.find("keyboard", at).speed <= TOP
    assert 0 < found.find("keyboard", now).speed <= TOP


@pytest.mark.parametrize("value", [0.0, -1.0, nan, 1e9])
def test_a_setting_that_means_nothing_is_refused(value: float) -> None:
    for name in CapSettings.__struct_fields__:
        with pytest.raises(msgspec.ValidationError):
            msgspec.convert({name: value}, CapSettings)


def test_a_speed_that_is_set_bounds_everybody_at_once_until_it_is_set_back() -> None:
    found = cap()
    found.note("keyboard", 1, 0.01, 1.0)
    assert found.find("keyboard", 1.0)[:2] == (TOP, "vehicle")
    found.tune(0.5)
    assert found.find("keyboard", 1.01)[:2] == (0.5, "parameter")
    assert found.rest()[:2] == (0.5, "parameter")
    found.tune(9 * TOP)
    assert found.find("keyboard", 1.02)[:2] == (TOP, "vehicle")
