from pathlib import Path

import pytest

from zteleop.bus.topics import TOPICS
from zteleop.control.settings import DriveSettings
from zteleop.drivers import open_driver
from zteleop.nodes import simulator
from zteleop.nodes.simulator import PERIOD
from zteleop.testing import Clock, FakeNode


def test_the_car_moves_as_its_chip_says_and_tells_where_it_is(
    node: FakeNode, clock: Clock, tmp_path: Path
) -> None:
    path = str(tmp_path / "chip")
    driver = open_driver("simulated", {"path": path})
    try:
        driver.start({0: 1509.6, 1: 1530.0})
        simulator.run(node, DriveSettings(), path)
        for throttle in (1509.6, 2040.0):
            driver.write({0: throttle, 1: 1530.0})
            for _ in range(100):
                clock.pass_by(PERIOD)
                node.loop.run(PERIOD)
            node.loop.run(TOPICS["odom"].every)
    finally:
        driver.close()
    still, moved = node.said["odom"].messages
    assert still.pose.pose.position.x == pytest.approx(0.0, abs=1e-6)
    assert moved.pose.pose.position.x > 0.3
    assert moved.twist.twist.linear.x > 0.5
    assert moved.header.stamp.sec > 0
