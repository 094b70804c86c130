import pytest

from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.progress import LEAST, STUCK, Progress
from zteleop.control.motion.trail import Trail
from zteleop.messages import Twist

PERIOD = 0.05


def stuck_after(asked: Twist, does: float, seconds: float = 10.0) -> float | None:
    """Return when a robot that does this share of what it is asked counts as stuck."""
    progress, trail, pose = Progress(), Trail(), Pose2D()
    for step in range(round(seconds / PERIOD)):
        progress.ask(asked, PERIOD)
        pose = pose.roll(does * asked.linear.x * PERIOD, does * asked.angular.z * PERIOD)
        trail.add(pose, step * PERIOD)
        if progress.is_stuck(trail, step * PERIOD):
            return step * PERIOD
    return None


@pytest.mark.parametrize("asked", [Twist.planar(0.5), Twist.planar(-0.2, 0.4), Twist.planar(0.0, -1.0)])
def test_who_does_hardly_anything_of_it_is_stuck(asked: Twist) -> None:
    assert stuck_after(asked, 0.0) == pytest.approx(STUCK, abs=2 * PERIOD)
    assert stuck_after(asked, LEAST / 2) == pytest.approx(STUCK, abs=2 * PERIOD)
    assert stuck_after(asked, 2 * LEAST) is None


def test_who_is_asked_for_nothing_is_not() -> None:
    assert stuck_after(Twist.planar(), 0.0) is None


def test_who_gets_stuck_later_is_noticed_then() -> None:
    progress, trail = Progress(), Trail()
    pose, found = Pose2D(), []
    for step in range(400):
        pose = pose if step > 100 else pose.ahead(0.5 * PERIOD)
        progress.ask(Twist.planar(0.5), PERIOD)
        trail.add(pose, step * PERIOD)
        if progress.is_stuck(trail, step * PERIOD):
            found.append(step * PERIOD)
    assert 5.0 + STUCK <= found[0] <= 5.0 + 2 * STUCK + PERIOD
