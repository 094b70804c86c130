import pytest

from zteleop.testing import Link


def carried(link: Link[int], count: int = 6) -> list[int]:
    return [out for thing in range(1, count + 1) for out in link.carry(thing)] + link.flush()


@pytest.mark.parametrize(
    ("link", "comes_out"),
    [
        (Link(), [1, 2, 3, 4, 5, 6]),
        (Link(drop=3), [1, 2, 4, 5]),
        (Link(repeat=2), [1, 2, 2, 3, 4, 4, 5, 6, 6]),
        (Link(swap=2), [1, 3, 2, 5, 4, 6]),
        (Link(drop=2, swap=3), [1, 3, 5, 6]),
        (Link(drop=1), []),
    ],
)
def test_it_does_by_count_what_links_do_by_chance(link: Link[int], comes_out: list[int]) -> None:
    assert carried(link) == comes_out


def test_what_is_held_back_at_the_end_can_still_be_had() -> None:
    link: Link[str] = Link(swap=1)
    assert link.carry("last") == []
    assert link.flush() == ["last"]
    assert link.flush() == []
