"""Where a Create 3 is docked, and from where it sees its dock."""

from math import radians

import pytest

from zteleop.messages import Header
from zteleop.sim.create3.docking import Place, is_docked, is_seen, status


@pytest.mark.parametrize(
    ("dock", "docked", "seen"),
    [
        (None, False, False),
        ((0.0, 0.0, 0.0), True, True),
        ((0.03, 0.02, radians(8)), True, True),
        ((-0.03, 0.0, 0.0), True, True),
        ((0.05, 0.0, 0.0), False, True),
        ((0.0, 0.0, radians(12)), False, True),
        ((0.0, 0.0, radians(-12)), False, True),
        ((0.9, 0.3, 1.0), False, True),
        ((1.1, 0.0, 0.0), False, False),
        ((-0.5, 0.0, 0.0), False, False),
        ((0.2, 0.6, 0.0), False, False),
    ],
)
def test_contacts_meet_within_centimetres_and_light_reaches_a_metre_ahead(
    dock: Place | None, docked: bool, seen: bool
) -> None:
    assert (is_docked(dock), is_seen(dock)) == (docked, seen)
    told = status(Header.zero(), dock)
    assert (told.is_docked, told.dock_visible) == (docked, seen)
