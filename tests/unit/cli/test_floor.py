"""The floor of the picture: what a simulator says, as long as it says it."""

from zteleop.cli._floor import LASTS, Floor
from zteleop.messages import String
from zteleop.sim.plan import Trace, to_text
from zteleop.testing import Clock, FakeNode

LINE = to_text([Trace([(0.0, 0.0), (1.0, 0.0)], "yellow")])


def test_a_scene_is_news_once(node: FakeNode) -> None:
    floor = Floor(node)  # type: ignore[arg-type]
    assert floor.news() is None
    node.hear("scene", String(LINE))
    (mark,) = floor.news() or ()
    assert mark.style == "yellow"
    node.hear("scene", String(LINE))
    assert floor.news() is None


def test_a_scene_that_nobody_says_any_more_is_no_more(node: FakeNode, clock: Clock) -> None:
    floor = Floor(node)  # type: ignore[arg-type]
    node.hear("scene", String(LINE))
    floor.news()
    clock.pass_by(LASTS - 0.1)
    assert floor.news() is None
    clock.pass_by(0.2)
    assert floor.news() == []
    assert floor.news() is None
    node.hear("scene", String(LINE))
    assert floor.news()


def test_what_is_no_scene_is_told_and_nothing_is_drawn(node: FakeNode) -> None:
    floor = Floor(node)  # type: ignore[arg-type]
    node.hear("scene", String("a.a = 1"))
    assert floor.news() == []
    assert node.warnings[0].startswith("not a scene: ")
