import threading
from contextlib import suppress
from types import SimpleNamespace

import pytest
from unit.bus.fakes import put

from zteleop.bus.overheard import OverheardRing


def keep(ring: OverheardRing, *texts: str) -> None:
    for text in texts:
        ring.take(put(text.encode()))


def taken(ring: OverheardRing) -> str:
    return "".join(sample.payload.decode() for sample in iter(ring.try_recv, None))


def test_samples_come_out_in_order() -> None:
    ring = OverheardRing(3)
    keep(ring, "a", "b")
    assert (taken(ring), ring.skipped, ring.try_recv()) == ("ab", 0, None)
    keep(ring, "c", "d", "e")
    assert (taken(ring), ring.skipped) == ("cde", 0)


def test_of_a_flood_the_newest_are_kept_and_the_rest_is_counted() -> None:
    ring = OverheardRing(3)
    keep(ring, *"abcdefg")
    assert (taken(ring), ring.skipped) == ("efg", 4)
    keep(ring, "h")
    assert (ring.recv().payload, ring.skipped) == (b"h", 4)


def test_whoever_waits_gets_what_comes_and_the_end() -> None:
    ring = OverheardRing(3)
    found: list[bytes] = []

    def wait() -> None:
        with suppress(EOFError):
            while True:
                found.append(ring.recv().payload)

    waiting = [threading.Thread(target=wait) for _ in range(2)]
    for thread in waiting:
        thread.start()
    keep(ring, "a", "b")
    ring.close()
    for thread in waiting:
        thread.join(10)
        assert not thread.is_alive()
    assert sorted(found) == [b"a", b"b"]


def test_what_is_undeclared_is_at_its_end() -> None:
    ring = OverheardRing(1)
    ring.undeclare()
    with pytest.raises(EOFError):
        ring.recv()


def test_who_hears_no_more_takes_back_what_fills_it() -> None:
    taken_back = []
    ring = OverheardRing(1)
    ring.declared = SimpleNamespace(undeclare=lambda: taken_back.append(True))
    ring.undeclare()
    assert taken_back == [True]
    with pytest.raises(EOFError):
        ring.recv()
