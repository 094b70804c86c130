import struct

import pytest

from zteleop.interfaces.cdr.runs import Part, end_of, run, runs


@pytest.mark.parametrize(
    ("parts", "phase", "text", "end"),
    [
        ([Part("B", 1), Part("d", 1)], 0, "<1B7x1d", 0),
        ([Part("B", 1), Part("d", 1)], 3, "<1B4x1d", 0),
        ([Part("d", 1)], 4, "<4x1d", 0),
        ([Part("H", 3)], 1, "<1x3H", 0),
        ([Part("s", 5), Part("I", 1)], 2, "<5s1x1I", 4),
    ],
)
def test_each_value_is_aligned_to_its_size(parts: list[Part], phase: int, text: str, end: int) -> None:
    found = run(parts, phase, "<")
    assert (found.packed.size, found.phase) == (struct.calcsize(text), end)


def test_there_is_a_format_for_each_place() -> None:
    assert [one.packed.size for one in runs([Part("I", 1)], ">")] == [4, 7, 6, 5, 4, 7, 6, 5]


def test_the_end_is_known_where_it_is_the_same_from_everywhere() -> None:
    assert end_of([Part("d", 1)], None) == 0
    assert end_of([Part("d", 1), Part("I", 1)], None) == 4
    assert end_of([Part("I", 1)], None) is None
    assert end_of([Part("I", 1)], 1) == 0
