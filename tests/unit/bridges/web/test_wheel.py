from itertools import count

import pytest

from zteleop.bridges.web.wheel import SILENCE, Wheel
from zteleop.bridges.web.words import Held
from zteleop.control.stick import Stick


class Pages:
    """Pages that say what they hold, and a clock."""

    def __init__(self) -> None:
        self.wheel, self.now = Wheel(), 100.0
        self._seq = count(1)

    def hold(self, page: str, drive: float | None, seq: int | None = None, after: float = 0.02) -> bool:
        self.now += after
        held = Held(seq or next(self._seq), drive or 0.0, 0.25, drive is not None, 1, self.now)
        return self.wheel.hear(page, held, self.now)

    @property
    def stick(self) -> Stick:
        return self.wheel.stick(self.now)


@pytest.fixture
def pages() -> Pages:
    return Pages()


DRIVEN = Stick(0.5, 0.25, deadman=True)


def test_whoever_holds_something_first_gets_the_wheel_and_drives(pages: Pages) -> None:
    pages.wheel.join("ann")
    pages.hold("ann", 0.5)
    assert (pages.wheel.holder, pages.stick) == ("ann", DRIVEN)
    assert pages.wheel.read(pages.now), "what is held is an act"
    pages.hold("ann", None)
    assert not pages.wheel.read(pages.now)


def test_who_held_something_before_the_wheel_was_free_must_let_go_first(pages: Pages) -> None:
    for page in ("ann", "bob"):
        pages.wheel.join(page)
    pages.hold("ann", 0.1)
    pages.hold("bob", 0.5)
    pages.wheel.hand_over("ann", pages.now)
    pages.hold("bob", 0.5)
    assert (pages.wheel.holder, pages.stick) == ("bob", Stick())
    pages.hold("bob", None)
    pages.hold("bob", 0.5)
    assert pages.stick == DRIVEN


@pytest.fixture
def driven(pages: Pages) -> Pages:
    """Ann drives."""
    for drive in (None, 0.1, None, 0.5):
        pages.hold("ann", drive)
    assert pages.stick == DRIVEN
    return pages


def test_a_page_that_falls_silent_holds_nothing_and_goes_on_when_it_is_heard(driven: Pages) -> None:
    driven.now += SILENCE + 0.001
    assert driven.stick == Stick()
    assert not driven.wheel.read(driven.now)
    driven.hold("ann", 0.5)
    assert driven.stick == DRIVEN, "for how long that may be is the robot's to say"


def test_what_is_older_or_another_pages_changes_nothing(driven: Pages) -> None:
    assert not driven.hold("ann", -1.0, seq=2)
    assert not driven.hold("bob", -1.0)
    assert (driven.wheel.holder, driven.stick) == ("ann", DRIVEN)


def test_who_drives_keeps_the_wheel_until_he_lets_go_or_is_silent(driven: Pages) -> None:
    assert driven.wheel.take("bob", driven.now) == "ann drives: it must let go, or hand over"
    assert driven.wheel.take("ann", driven.now) == ""
    driven.hold("ann", None)
    assert driven.wheel.take("bob", driven.now) == ""
    assert driven.wheel.holder == "bob"
    assert driven.stick == Stick()
    assert not driven.hold("ann", 0.5)


def test_who_takes_a_wheel_with_a_key_held_must_let_go_first(driven: Pages) -> None:
    driven.hold("bob", 0.5)
    driven.now += SILENCE + 0.001
    driven.wheel.take("bob", driven.now)
    driven.hold("bob", 0.5)
    assert driven.stick == Stick()
    driven.hold("bob", None)
    driven.hold("bob", 0.5)
    assert driven.stick == DRIVEN


def test_a_wheel_is_handed_over_by_who_has_it_while_he_drives(driven: Pages) -> None:
    assert driven.wheel.hand_over("bob", driven.now) == "ann has the wheel"
    assert driven.wheel.hand_over("ann", driven.now) == ""
    assert (driven.wheel.holder, driven.stick) == ("", Stick())
    assert driven.wheel.rested, "neutral is said before anybody else drives"
    assert driven.wheel.hand_over("ann", driven.now) == "nobody has the wheel"


def test_a_page_that_is_gone_holds_nothing(driven: Pages) -> None:
    driven.wheel.leave("bob", driven.now)
    assert driven.stick == DRIVEN
    driven.wheel.leave("ann", driven.now)
    assert (driven.wheel.holder, driven.stick) == ("", Stick())


def test_after_a_reset_what_is_held_must_be_let_go(driven: Pages) -> None:
    driven.wheel.reset(driven.now)
    driven.hold("ann", 0.5)
    assert driven.stick == Stick()
    driven.hold("ann", None)
    driven.hold("ann", 0.5)
    assert driven.stick == DRIVEN


def test_a_reset_while_nothing_is_held_asks_for_nothing_more(driven: Pages) -> None:
    driven.hold("ann", None)
    driven.wheel.reset(driven.now)
    driven.hold("ann", 0.5)
    assert driven.stick == DRIVEN
