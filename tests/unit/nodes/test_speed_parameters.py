from types import SimpleNamespace

import pytest

from zteleop.control.stick import Speeds
from zteleop.errors import ConfigError
from zteleop.nodes.speed_parameters import FOLLOW_EVERY, offer_speeds
from zteleop.testing import FakeNode


@pytest.fixture
def device() -> SimpleNamespace:
    return SimpleNamespace(speeds=Speeds(0.5, 1.0))


def test_others_change_what_a_full_stick_means(node: FakeNode, device: SimpleNamespace) -> None:
    offer_speeds(node, device)  # type: ignore[arg-type]
    node.parameters["speeds.forward"].set(0.25)
    assert device.speeds == Speeds(0.25, 1.0)
    node.parameters["speeds.turn"].set(2)
    assert device.speeds == Speeds(0.25, 2.0)


@pytest.mark.parametrize("value", [-0.1, 101.0])
def test_a_speed_that_is_none_is_refused(node: FakeNode, device: SimpleNamespace, value: float) -> None:
    offer_speeds(node, device)  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match="expected 0 to 100"):
        node.parameters["speeds.forward"].set(value)
    assert device.speeds == Speeds(0.5, 1.0)


def test_what_keys_change_is_seen(node: FakeNode, device: SimpleNamespace) -> None:
    offer_speeds(node, device)  # type: ignore[arg-type]
    device.speeds = Speeds(0.75, 1.5)
    node.live(FOLLOW_EVERY)
    assert [one.value for one in node.parameters.values()] == [0.75, 1.5]
