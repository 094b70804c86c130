from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.door.backlog import Backlog


def drained(backlog: Backlog[str]) -> list[str]:
    found = []
    while backlog:
        found.append(backlog.next)
        backlog.drop()
    return found


def test_each_kind_has_its_turn() -> None:
    backlog = Backlog[str](100)
    for item in ("a1", "a2", "a3", "b1", "c1", "b2"):
        backlog.add(item[0], item, 1)
    assert (backlog.has("b"), backlog.has("d")) == (True, False)
    assert drained(backlog) == ["a1", "b1", "c1", "a2", "b2", "a3"]
    assert not backlog


def test_who_comes_while_others_wait_waits_for_one_of_each() -> None:
    backlog = Backlog[str](1000)
    for number in range(500):
        backlog.add("flood", f"flood {number}", 1)
    backlog.add("command", "go", 1)
    assert drained(backlog).index("go") == 1


def test_what_is_too_much_is_lost_but_for_one_of_a_kind() -> None:
    backlog = Backlog[str](10)
    for number in range(5):
        backlog.add("flood", f"{number}", 4)
    backlog.add("command", "go", 4)
    assert drained(backlog) == ["0", "go", "1", "2"]


@given(st.lists(st.sampled_from("abcd")), st.integers(1, 50))
def test_those_of_one_kind_keep_their_order(kinds: list[str], most: int) -> None:
    backlog = Backlog[str](most)
    for number, kind in enumerate(kinds):
        backlog.add(kind, f"{kind}{number:04}", 1)
    found = drained(backlog)
    for kind in "abcd":
        own = [item for item in found if item[0] == kind]
        assert own == sorted(own)
        assert bool(own) == (kind in kinds)
