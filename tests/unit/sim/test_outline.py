from itertools import pairwise
from math import atan2, dist, hypot, pi, remainder, tau

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.sim import outline

SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]


def test_a_square_bent_by_half_its_side_is_a_circle() -> None:
    line = outline.rounded(SQUARE, True, 1.0)
    assert [hypot(x - 1, y - 1) for x, y in line] == pytest.approx([1.0] * len(line))
    length = sum(dist(*side) for side in outline.sides(line, closed=True))
    assert length == pytest.approx(tau, rel=1e-3)


@pytest.mark.parametrize("points", [SQUARE, SQUARE[::-1]])
def test_both_turns_are_bent_inwards(points: list[outline.Point]) -> None:
    line = outline.rounded(points, True, 0.5)
    assert outline.area(line) == pytest.approx(4 - (4 - pi) * 0.25, abs=0.003)
    assert all(-1e-9 <= value <= 2 + 1e-9 for point in line for value in point)


def test_an_open_line_keeps_its_ends() -> None:
    line = outline.rounded(SQUARE, False, 0.5)
    assert (line[0], line[-1]) == (SQUARE[0], SQUARE[-1])
    assert len(line) > 20


@given(st.floats(0.01, 0.7), st.booleans())
def test_a_bent_line_turns_by_little_at_a_time(radius: float, closed: bool) -> None:
    line = outline.rounded([(0, 0), (4, 0), (4, 4), (2, 1.5), (0, 4)], closed, radius)
    bearings = [atan2(b[1] - a[1], b[0] - a[0]) for a, b in outline.sides(line, closed)]
    assert max(abs(remainder(b - a, tau)) for a, b in pairwise(bearings)) <= outline.ARC_STEP + 1e-6
    assert min(dist(*side) for side in outline.sides(line, closed)) >= outline.SHORTEST


def test_what_is_straight_needs_no_bend() -> None:
    assert outline.rounded([(0, 0), (1, 0), (2, 0)], False, 5.0) == [(0, 0), (1, 0), (2, 0)]


def test_a_bend_without_room_is_named() -> None:
    with pytest.raises(
        ValueError, match=r"a bend of 1.2 m needs 2.4 m from points\[0\] to points\[1\], which are 2 m"
    ):
        outline.rounded(SQUARE, True, 1.2)
    with pytest.raises(ValueError, match=r"points\[1\] turns straight back"):
        outline.rounded([(0, 0), (1, 0), (0, 0)], False, 0.1)


@pytest.mark.parametrize(
    ("points", "closed", "why"),
    [
        ([(0, 0), (1, 0), (1, 0)], False, r"points\[1\] and points\[2\] are one place, 1, 0"),
        ([(0, 0), (1, 0)], True, "at least 3 points, found 2"),
        ([*SQUARE, SQUARE[0]], True, "the last point is the first again"),
    ],
)
def test_impossible_lines_are_refused(points: list[outline.Point], closed: bool, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        outline.check(points, closed)


def test_good_lines_pass() -> None:
    outline.check(SQUARE, closed=True)
    outline.check([*SQUARE, SQUARE[0]], closed=False)


@pytest.mark.parametrize(
    ("x", "y", "inside"), [(1, 1, True), (0.01, 1.99, True), (-0.1, 1, False), (1, 2.1, False)]
)
def test_a_square_encloses_what_is_in_it(x: float, y: float, inside: bool) -> None:
    assert outline.encloses(SQUARE, x, y) is inside
    assert outline.encloses(SQUARE[::-1], x, y) is inside


def test_an_area_does_not_mind_the_way_round() -> None:
    assert outline.area(SQUARE) == outline.area(SQUARE[::-1]) == 4.0
