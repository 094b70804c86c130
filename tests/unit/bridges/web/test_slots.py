from threading import Thread

import pytest

from zteleop.bridges.web.slots import Slots


class Page:
    """Counts how often it is woken."""

    def __init__(self) -> None:
        self.woken = 0
        self.slots = Slots(self.wake)

    def wake(self) -> None:
        self.woken += 1

    def take_all(self) -> list[object]:
        return list(iter(self.slots.take, None))


@pytest.fixture
def page() -> Page:
    return Page()


def test_of_each_kind_the_newest_waits(page: Page) -> None:
    for number in range(3):
        page.slots.put("odom", f"odom {number}")
        page.slots.put("beat", f"beat {number}")
    assert page.take_all() == ["odom 2", "beat 2"]
    assert page.slots.skipped == 4


def test_who_waits_the_longest_comes_first_however_often_it_was_replaced(page: Page) -> None:
    for kind in ("picture", "odom", "picture", "beat", "picture"):
        page.slots.put(kind, kind)
    assert page.take_all() == ["picture", "odom", "beat"]
    page.slots.put("beat", "beat")
    page.slots.put("picture", "picture")
    assert page.slots.take() == "beat"
    page.slots.put("beat", "newer")
    assert page.take_all() == ["picture", "newer"], "what is said all the time keeps nothing waiting"


def test_it_wakes_once_until_all_was_taken(page: Page) -> None:
    page.slots.put("a", "1")
    page.slots.put("b", "2")
    assert page.woken == 1
    page.slots.take()
    page.slots.put("a", "3")
    assert page.woken == 1, "whoever takes goes on until there is nothing"
    page.take_all()
    page.slots.put("a", "4")
    assert page.woken == 2


def test_what_several_threads_put_is_all_there(page: Page) -> None:
    def put(name: int) -> None:
        for number in range(500):
            page.slots.put(f"{name} {number}", "x")

    threads = [Thread(target=put, args=(name,)) for name in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (len(page.take_all()), page.woken) == (2000, 1)
