from itertools import permutations

import pytest

from zteleop.control.hold import HOLDS, Holds
from zteleop.messages import State


def test_without_a_reason_it_is_free() -> None:
    holds = Holds()
    assert not holds
    assert holds.strongest is None
    assert not holds.drop("chip")


@pytest.mark.parametrize("order", list(permutations(HOLDS)))
def test_of_several_reasons_the_strongest_is_told_in_whatever_order_they_came(order: list[State]) -> None:
    holds = Holds()
    for state in order:
        holds.add(state, state, "", 1.0)
    for state in ("fault", "stopped", "starting"):
        assert holds.strongest.state == state
        assert holds.drop(state)
    assert not holds


def test_a_reason_said_in_new_words_is_as_old_as_before() -> None:
    holds = Holds()
    holds.add("chip", "fault", "it is silent", 1.0)
    holds.add("chip", "fault", "it answers wrongly", 5.0)
    assert holds.strongest == ("fault", "it answers wrongly", 1.0)
    holds.drop("chip")
    holds.add("chip", "fault", "it is silent", 9.0)
    assert holds.strongest.since == 9.0
