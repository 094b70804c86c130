from collections import deque
from types import SimpleNamespace

from zteleop.cli.keyboard import TRAIL_STEP, follow
from zteleop.messages import Odometry


def at(x: float, y: float) -> SimpleNamespace:
    odom = Odometry.zero()
    odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
    return SimpleNamespace(odom=odom)


def test_a_trail_is_where_the_robot_has_been() -> None:
    trail: deque[tuple[float, float]] = deque(maxlen=3)
    follow(trail, SimpleNamespace(odom=None))
    assert not trail
    for x in (0.0, TRAIL_STEP / 2, 2 * TRAIL_STEP, 2.1 * TRAIL_STEP):
        follow(trail, at(x, 0.0))
    assert list(trail) == [(0.0, 0.0), (2 * TRAIL_STEP, 0.0)]
    follow(trail, at(2 * TRAIL_STEP, -2 * TRAIL_STEP))
    assert trail[-1] == (2 * TRAIL_STEP, -2 * TRAIL_STEP)
