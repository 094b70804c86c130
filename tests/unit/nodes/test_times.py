import pytest

from zteleop.messages import Hop
from zteleop.nodes.times import MOST, Times
from zteleop.testing import Clock, FakeNode


@pytest.fixture
def node(clock: Clock) -> FakeNode:
    return FakeNode(clock=clock)


def test_once_a_second_it_is_told_how_long_each_part_took_and_how_long_at_the_worst(node: FakeNode) -> None:
    times = Times(node, lambda: "keyboard 18d4")
    for milliseconds in (3, 1, 9):
        times.note("act to bus", milliseconds / 1000)
    times.note("bus to Mars", 200.0)
    node.loop.live(1.1)
    (told,) = node.said["latency"].messages
    assert told.by == "keyboard 18d4"
    assert told.hops == [Hop("act to bus", 3, 0.003, 0.009), Hop("bus to Mars", 1, 200.0, 200.0)]


def test_what_was_told_is_not_told_again_and_where_nothing_passes_nothing_is_due(node: FakeNode) -> None:
    times = Times(node, lambda: "keyboard 18d4")
    node.loop.live(5.0)
    times.note("act to bus", 1.0)
    node.loop.live(1.1)
    node.loop.live(5.0)
    times.note("act to bus", 2.0)
    node.loop.live(1.1)
    assert [told.hops[0].median for told in node.said["latency"].messages] == [1.0, 2.0]


def test_a_flood_is_measured_by_its_first(node: FakeNode) -> None:
    times = Times(node, lambda: "actuator")
    for _ in range(2 * MOST):
        times.note("door to actuator", 0.1)
    node.loop.live(1.1)
    assert node.said["latency"].messages[0].hops[0].commands == MOST
