from math import cos, pi, sin
from random import Random
from statistics import fmean

import pytest

from zteleop.sim.noise import LEVELS, Noise
from zteleop.sim.odometer import HH, HX, XH, XX, XY, YX, YY, Odometer


def drive(odometer: Odometer, way: float, turn: float, steps: int = 100) -> Odometer:
    for _ in range(steps):
        odometer.add(way / steps, turn / steps)
    return odometer


def test_without_noise_it_is_exact() -> None:
    odometer = drive(Odometer(), pi, pi)
    assert (odometer.x, odometer.y) == pytest.approx((0.0, 2.0), abs=1e-3)
    assert abs(odometer.heading) == pytest.approx(pi)
    assert odometer.covariance == [0.0] * 36


def test_it_counts_back_and_forth_and_forgets_the_place_alone() -> None:
    odometer = drive(drive(Odometer(Noise(way=0.1)), 1.0, 0.0), -1.0, 0.0)
    assert odometer.distance == pytest.approx(2.0)
    odometer.reset()
    assert (odometer.x, odometer.y, odometer.heading, odometer.covariance) == (0, 0, 0, [0.0] * 36)
    assert odometer.distance == pytest.approx(2.0)


def test_who_stands_drifts_nowhere() -> None:
    odometer = drive(Odometer(LEVELS["high"], Random(1)), 0.0, 0.0)
    assert (odometer.x, odometer.y, odometer.heading, odometer.covariance) == (0, 0, 0, [0.0] * 36)


def test_the_seed_decides_the_drift() -> None:
    def end(seed: int) -> tuple[float, float]:
        odometer = drive(Odometer(LEVELS["high"], Random(seed)), 5.0, 1.0)
        return odometer.x, odometer.y

    assert end(1) == end(1) != end(2)


@pytest.mark.parametrize("level", ["low", "high"])
def test_the_covariance_says_how_far_off_it_is(level: str) -> None:
    way, turn, times = 4.0, 1.5, 400
    ends = [drive(Odometer(LEVELS[level], Random(seed)), way, turn) for seed in range(times)]
    true = drive(Odometer(), way, turn)
    off = [(one.x - true.x, one.y - true.y, one.heading - true.heading) for one in ends]
    said = [fmean(values) for values in zip(*(one.covariance for one in ends), strict=True)]
    for place, first, second in ((XX, 0, 0), (YY, 1, 1), (HH, 2, 2), (XY, 0, 1), (XH, 0, 2)):
        found = fmean(error[first] * error[second] for error in off)
        scale = (fmean(e[first] ** 2 for e in off) * fmean(e[second] ** 2 for e in off)) ** 0.5
        assert said[place] == pytest.approx(found, abs=0.25 * scale), place
    assert (said[YX], said[HX]) == (said[XY], said[XH])


def test_after_a_metre_straight_ahead_it_is_off_by_what_the_settings_say() -> None:
    noise = Noise(way=0.02, drift=0.03)
    covariance = drive(Odometer(noise), 1.0, 0.0).covariance
    assert covariance[XX] == pytest.approx(0.02**2, rel=0.05)
    assert covariance[HH] == pytest.approx(0.03**2, rel=0.05)
    assert covariance[YY] == pytest.approx(0.03**2 / 3, rel=0.1)


def test_a_turn_on_the_spot_costs_heading_alone() -> None:
    covariance = drive(Odometer(Noise(turn=0.05)), 0.0, -1.0).covariance
    assert covariance[HH] == pytest.approx(0.05**2)
    assert (covariance[XX], covariance[YY]) == (0.0, 0.0)


def test_it_counts_along_where_it_looks() -> None:
    odometer = Odometer()
    odometer.add(0.0, 0.5)
    odometer.add(2.0, 0.0)
    assert (odometer.x, odometer.y) == pytest.approx((2 * cos(0.5), 2 * sin(0.5)))
