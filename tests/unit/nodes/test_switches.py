from zteleop.messages import Bool
from zteleop.nodes.switches import EVERY, Switches
from zteleop.testing import FakeNode


def test_a_switch_is_said_at_once_and_again_for_whoever_comes_later(node: FakeNode) -> None:
    switches = Switches(node)
    switches.heed({})
    node.loop.run(EVERY)
    assert "lights" not in node.said
    switches.heed({"lights": True})
    switches.heed({"lights": True})
    assert node.said["lights"].take() == [Bool(True)]
    switches.heed({"lights": False, "horn": True})
    assert (node.said["lights"].take(), node.said["horn"].take()) == ([Bool(False)], [Bool(True)])
    node.loop.run(EVERY)
    assert (node.said["lights"].take(), node.said["horn"].take()) == ([Bool(False)], [Bool(True)])
