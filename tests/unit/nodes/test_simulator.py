import re
from pathlib import Path

import pytest
from msgspec.structs import replace

from zteleop.bus.topics import TOPICS
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.control.vehicles import VEHICLES
from zteleop.drivers import open_driver
from zteleop.drivers.registers import read_pulse_us
from zteleop.nodes import simulator
from zteleop.nodes.simulator import AT_REST, PERIOD, TELL_EVERY, Simulated
from zteleop.sim.noise import LEVELS
from zteleop.sim.scene import Scene, Wall
from zteleop.testing import Clock, FakeNode


def test_the_car_moves_as_its_chip_says_and_tells_where_it_is(
    node: FakeNode, clock: Clock, tmp_path: Path
) -> None:
    path, shown = str(tmp_path / "chip"), list[str]()
    driver = open_driver("simulated", {"path": path})
    try:
        driver.start({0: 1509.6, 1: 1530.0})
        simulator.run(node, DriveSettings(), path, shown.append)
        for throttle in (1509.6, 2040.0, 1509.6, 1509.6):
            driver.write({0: throttle, 1: 1530.0})
            for _ in range(100):
                clock.pass_by(PERIOD)
                node.loop.run(PERIOD)
            node.loop.run(TOPICS["odom"].every)
            node.loop.run(TELL_EVERY)
    finally:
        driver.close()
    still, moved, *_ = node.said["odom"].messages
    assert still.pose.pose.position.x == pytest.approx(0.0, abs=1e-6)
    assert moved.pose.pose.position.x > 0.3
    assert moved.twist.twist.linear.x > 0.5
    assert moved.header.stamp.sec > 0
    drives, *rolls, stands = shown
    assert re.match(r" [0-9.]+ m/s  x +[0-9.]+ m  y +0.00 m  heading +0 deg  rolled [0-9.]+ m$", drives)
    assert stands.startswith(" 0.00 m/s  ")
    assert len(rolls) < 2, "it stands, and says it again and again"


def test_a_car_that_stands_is_looked_at_less_often(
    node: FakeNode, clock: Clock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = str(tmp_path / "chip")
    driver = open_driver("simulated", {"path": path})
    looks = []
    monkeypatch.setattr(
        simulator, "read_pulse_us", lambda *seen: looks.append(clock.time) or read_pulse_us(*seen)
    )
    try:
        driver.start({0: 1509.6})
        simulator.run(node, DriveSettings(), path, print)
        node.live(1.0)
        per_look = 2  # channels
        assert len(looks) // per_look == pytest.approx(1.0 / AT_REST, abs=2)
        driver.write({0: 2040.0})
        node.live(0.2)
        looks.clear()
        node.live(0.5)
        assert len(looks) // per_look == pytest.approx(0.5 / PERIOD, abs=2)
    finally:
        driver.close()


def test_wheels_that_err_say_how_wrong_they_may_be(node: FakeNode, clock: Clock, tmp_path: Path) -> None:
    path = str(tmp_path / "chip")
    driver = open_driver("simulated", {"path": path})
    try:
        driver.start({0: 2040.0, 1: 1530.0})
        simulated = Simulated(noise=LEVELS["high"], scene=Scene(walls=[Wall([(9.0, -1.0), (9.0, 1.0)])]))
        simulator.run(node, DriveSettings(), path, print, simulated)
        node.live(1.0)
        node.loop.run(TOPICS["range"].every)
    finally:
        driver.close()
    covariance = node.said["odom"].messages[-1].pose.covariance
    assert covariance[0] > 0
    assert node.said["range"].messages[-1].variance > 0


@pytest.mark.parametrize("kind", ["car", "create3"])
def test_a_battery_begins_with_the_charge_asked_for(node: FakeNode, tmp_path: Path, kind: str) -> None:
    built = VEHICLES[kind]
    settings = DriveSettings(mixer=built.mixer, servos=built.servos)
    simulator.run(node, settings, str(tmp_path / "chip"), print, Simulated(kind, charge=0.2))
    node.live(1.5)
    assert node.said["battery_state"].messages[0].percentage == pytest.approx(0.2, abs=0.01)


def test_a_seed_is_the_same_unknown_car_whatever_was_found_out_of_it_meanwhile() -> None:
    found = {name: replace(servo, neutral_us=servo.neutral_us + 40) for name, servo in DONKEYCAR.items()}
    found["throttle"] = replace(found["throttle"], channel=5)
    before = simulator.unknown_car(DriveSettings(), 3)
    after = simulator.unknown_car(DriveSettings(servos=found), 3)
    assert after._steering == before._steering
    assert after._throttle == replace(before._throttle, channel=5)
    assert after._settings == before._settings
