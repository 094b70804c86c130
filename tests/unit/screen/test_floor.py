import pytest

from zteleop.cli._scenes import find
from zteleop.screen.floor import marks
from zteleop.sim.plan import Trace, plan


@pytest.mark.parametrize(("colour", "style"), [("yellow", "yellow"), ("orange", "red"), ("brown", "")])
def test_a_line_has_the_colour_that_a_terminal_has_for_it(colour: str, style: str) -> None:
    (mark,) = marks([Trace([(0.0, 0.0), (1.0, 0.0)], colour)])  # type: ignore[arg-type]
    assert (mark.points, mark.style) == ([(0.0, 0.0), (1.0, 0.0)], style)


def test_a_demo_has_a_line_ahead_and_two_cones() -> None:
    found = marks(plan(find("eight")))
    assert sorted(mark.style for mark in found) == ["red", "red", "yellow", "yellow"]
    ahead = [
        point for mark in found if mark.style == "yellow" for point in mark.points if abs(point[1]) < 0.05
    ]
    assert max(x for x, _ in ahead) > 0.1
