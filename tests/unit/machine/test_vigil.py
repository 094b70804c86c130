import os
import sys

import pytest

from zteleop.control.deadlines import DOOR_SILENCE, DOOR_START, LONGEST_OPENING
from zteleop.machine import vigil
from zteleop.machine.vigil import LARGEST, WEIGH_EVERY, Vigil, weigh

PID = os.getpid()


def test_each_that_does_not_open_gives_the_next_more_time() -> None:
    watch = Vigil()
    now, given = 0.0, []
    for _ in range(4):
        watch.begin(now)
        patience = next(s for s in range(100) if watch.judge(PID, is_open=False, now=now + s + 0.01))
        given.append(patience)
        now += 100.0
    assert given == [DOOR_START, 2 * DOOR_START, 4 * DOOR_START, LONGEST_OPENING]


def test_one_that_opened_makes_the_next_as_patient_as_the_first() -> None:
    watch = Vigil()
    watch.begin(0.0)
    assert "the next has 20 s" in watch.judge(PID, is_open=False, now=DOOR_START + 1)
    watch.hear(DOOR_START + 2, first=True)
    watch.begin(30.0)
    assert "did not open within 10 s" in watch.judge(PID, is_open=False, now=30.0 + DOOR_START + 1)


def test_silence_is_counted_from_the_last_word(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vigil, "weigh", lambda pid: 0)
    watch = Vigil()
    watch.hear(1.0, first=True)
    assert watch.judge(PID, is_open=True, now=1.0 + DOOR_SILENCE) == ""
    assert watch.judge(PID, is_open=True, now=1.1 + DOOR_SILENCE) == "it was silent for 0.6 s"


def test_it_is_weighed_now_and_then_and_may_not_grow(monkeypatch: pytest.MonkeyPatch) -> None:
    weights = iter([LARGEST, LARGEST + 2**20])
    monkeypatch.setattr(vigil, "weigh", lambda pid: next(weights))
    watch = Vigil()

    def judged(now: float) -> str:
        watch.hear(now, first=False)
        return watch.judge(PID, is_open=True, now=now)

    assert [judged(now) for now in (0.0, 0.1, WEIGH_EVERY)] == ["", "", ""]
    assert judged(WEIGH_EVERY + 0.1) == "it had grown to 193 MB, of 192"


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_a_weight_is_what_a_process_holds_by_itself() -> None:
    assert 2**20 < weigh(PID) < 2**30


def test_a_process_that_is_gone_weighs_nothing() -> None:
    assert weigh(2**22 + 1) == 0
