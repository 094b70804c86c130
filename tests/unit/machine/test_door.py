"""Real processes that are as good as a door, in the test's time."""

import errno
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from zteleop.control.deadlines import DOOR_SILENCE, DOOR_START, LATE_STEP
from zteleop.machine import door as module
from zteleop.machine import vigil
from zteleop.machine.backoff import FIRST_PAUSE, STEADY
from zteleop.machine.door import Door
from zteleop.machine.vigil import LARGEST, WEIGH_EVERY

LISTENS = """
import os, sys
link = int(sys.argv[2])
sys.stdin.read()
{says}
os.read(link, 1)
"""
OPENS = LISTENS.format(says="os.write(link, b'.')")
NEVER_OPENS = LISTENS.format(says="")
REFUSES = "raise SystemExit(3)"
STEP = LATE_STEP / 2
PATIENCE = 30.0


class House:
    """Whoever watches over a door, in a time of his own."""

    def __init__(self, folder: Path, program: str = OPENS) -> None:
        self.words: list[str] = []
        self.orders: list[bool] = []
        command = [sys.executable, "-S", "-c", program]
        self.door = Door(command, self._order, str(folder / "door"), self.words.append)
        self.now = 100.0
        self.door.start(self.now)

    def _order(self, first: bool) -> bytes:
        self.orders.append(first)
        return b"{}"

    def until(self, look: Callable[[], object]) -> None:
        """Tend it, while the test's time stands, until something is so."""
        give_up = time.monotonic() + PATIENCE
        while not look():
            assert time.monotonic() < give_up
            self.door.tend(self.now)
            time.sleep(0.002)

    def opened(self) -> "House":
        self.until(lambda: self.door.is_open)
        return self

    def kill(self) -> None:
        assert self.door._process
        self.door._process.kill()
        self.door._process.wait()

    def tend(self, seconds: float) -> None:
        """Let time pass, and tend it all the while."""
        end = self.now + seconds
        while self.now < end:
            self.now = min(self.now + STEP, end)
            self.door.tend(self.now)


@pytest.fixture
def opened(tmp_path: Path) -> Iterator[House]:
    house = House(tmp_path).opened()
    yield house
    house.door.close()


def test_one_that_breaks_is_followed_by_another_at_once(opened: House) -> None:
    opened.kill()
    opened.until(lambda: opened.door.starts == 2)
    opened.opened()
    assert opened.words == [
        "the door to the bus is shut: it ended; another opens, and nobody drives meanwhile",
        "the door is open again, 0.0 s after its start",
    ]
    assert opened.orders == [True, False]


def test_of_those_that_break_in_a_row_each_comes_later(opened: House) -> None:
    pauses = []
    for start in range(2, 6):
        opened.kill()
        before = opened.now
        while opened.door.starts < start:
            opened.tend(0.01)
        pauses.append(round(opened.now - before, 2))
        opened.opened()
    looks = 0.01
    assert pauses == pytest.approx([2 * looks, *(times * FIRST_PAUSE + looks for times in (1, 2, 4))])
    assert "another opens in 0.4 s, and nobody drives meanwhile" in opened.words[-2]


def test_one_that_broke_is_open_no_more(opened: House) -> None:
    opened.kill()
    opened.until(lambda: opened.words)
    assert (opened.door.is_open, opened.door.starts) == (False, 1)


def test_one_that_was_long_open_does_not_count_as_in_a_row(
    opened: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(vigil, "DOOR_SILENCE", float("inf"))
    for start in (2, 3):
        opened.tend(STEADY + 1)
        opened.kill()
        opened.until(lambda start=start: opened.door.starts == start)  # type: ignore[misc]
        opened.opened()


def test_one_that_falls_silent_is_ended_and_followed(opened: House) -> None:
    opened.tend(DOOR_SILENCE)
    assert opened.words == []
    opened.tend(2 * STEP)
    opened.until(lambda: opened.door.starts == 2)
    assert opened.words[0].startswith("the door to the bus is shut: it was silent for 0.6 s; another opens")


def test_whoever_was_late_himself_listens_before_he_judges(opened: House) -> None:
    opened.now += 10 * DOOR_SILENCE
    opened.door.tend(opened.now)
    assert opened.words == []


def test_one_that_grows_beyond_its_limit_is_ended(opened: House, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vigil, "DOOR_SILENCE", float("inf"))
    monkeypatch.setattr(vigil, "weigh", lambda pid: LARGEST + 2**20)
    opened.tend(WEIGH_EVERY + STEP)
    assert opened.words[0].startswith("the door to the bus is shut: it had grown to 193 MB, of 192; another")


def test_one_that_never_opened_and_said_why_is_not_followed(tmp_path: Path) -> None:
    house = House(tmp_path, REFUSES)
    house.until(lambda: house.door.refused)
    house.tend(1.0)
    assert (house.door.refused, house.door.starts, house.words) == (3, 1, [])
    house.door.close()


def test_one_that_opens_too_slowly_leaves_the_next_more_time(tmp_path: Path) -> None:
    house = House(tmp_path, NEVER_OPENS)
    house.tend(DOOR_START + STEP)
    assert house.words[0].startswith(
        "the door to the bus is shut: it did not open within 10 s of its start, and the next has 20 s;"
    )
    house.until(lambda: house.door.starts == 2)
    house.tend(DOOR_START + STEP)
    assert len(house.words) == 1
    house.door.close()


def test_its_end_is_awaited_and_a_frozen_one_is_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "ENDS_WITHIN", 0.05)
    house = House(tmp_path).opened()
    process = house.door._process
    assert process
    os.kill(process.pid, signal.SIGSTOP)
    house.door.close()
    assert process.returncode == -signal.SIGKILL


def test_its_end_in_order_is_left_to_it(opened: House) -> None:
    process = opened.door._process
    assert process
    opened.door.close()
    assert process.returncode == 0


def test_one_that_the_system_cannot_start_is_tried_ever_later_and_ends_nobody(
    opened: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable")

    monkeypatch.setattr(vigil, "DOOR_SILENCE", float("inf"))
    opened.tend(STEADY + 1)
    with monkeypatch.context() as without:
        without.setattr(module.subprocess, "Popen", full)
        opened.kill()
        opened.tend(1.0)
        said = [words for words in opened.words if "none can be started (Resource" in words]
        assert 3 <= len(said) <= 6
    opened.until(lambda: opened.door.is_open or opened.tend(0.1))
