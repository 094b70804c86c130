"""Time is what the test says: where the loop would wait, the clock goes on."""

import os
import select
from collections.abc import Callable, Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.loop import FAR, LONGEST_WAIT, Loop, Timer
from zteleop.control.proof import NEVER
from zteleop.testing import Clock

real_select = select.select


def nothing() -> None:
    pass


@pytest.fixture
def waits(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """How long the loop waited, without having waited."""
    waits: list[float] = []

    def wait(read: list[int], write: list[int], error: list[int], timeout: float) -> tuple:
        waits.append(timeout)
        assert len(waits) < 10_000, "the loop spins"
        ready = real_select(read, write, error, 0)
        if not ready[0]:
            clock.pass_by(timeout)
        return ready

    monkeypatch.setattr(select, "select", wait)
    return waits


@pytest.fixture
def loop(waits: list[float]) -> Iterator[Loop]:
    loop = Loop(before_each=nothing)
    yield loop
    loop.close()


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    ends = os.pipe()
    yield ends
    for end in ends:
        os.close(end)


def test_a_timer_keeps_another_pace_from_now_on(loop: Loop, clock: Clock) -> None:
    start, times = clock.time, []
    timer = loop.every(0.2, lambda: times.append(clock.time - start))
    loop.run(until=start + 0.06)
    timer.pace(0.05, clock.time)  # sooner than it was to fire
    loop.run(until=start + 0.22)
    timer.pace(0.2, clock.time)
    loop.run(until=start + 0.9)
    assert times == pytest.approx([0.0, 0.1, 0.15, 0.2, 0.25, 0.4, 0.6, 0.8])


def test_timers_that_were_made_together_fire_together_at_any_pace(loop: Loop, clock: Clock) -> None:
    wakes = set()
    pacing, _ = (loop.every(0.05, lambda: wakes.add(round(clock.time, 6))) for _ in range(2))
    loop.run(until=clock.time + 0.12)
    pacing.pace(0.02, clock.time)
    loop.run(until=clock.time + 0.11)
    pacing.pace(0.05, clock.time)
    loop.run(until=clock.time + 0.15)
    wakes.clear()
    loop.run(until=clock.time + 1.0)
    assert len(wakes) <= 21


def test_a_timer_fires_at_once_and_then_on_its_schedule(loop: Loop, clock: Clock) -> None:
    start, times = clock.time, []
    loop.every(0.1, lambda: times.append(clock.time - start))
    loop.run(until=start + 0.45)
    assert times == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert clock.time == pytest.approx(start + 0.45)


def test_what_an_action_takes_does_not_shift_the_schedule(loop: Loop, clock: Clock) -> None:
    start, times = clock.time, []

    def work() -> None:
        times.append(clock.time - start)
        clock.pass_by(0.03)

    loop.every(0.1, work)
    loop.run(until=start + 0.45)
    assert times == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])


def test_missed_ticks_are_not_made_up_for(loop: Loop, clock: Clock) -> None:
    start, times = clock.time, []

    def work() -> None:
        times.append(clock.time - start)
        clock.pass_by(0.35 if len(times) == 1 else 0.0)

    loop.every(0.1, work)
    loop.run(until=start + 0.55)
    assert times == pytest.approx([0.0, 0.35, 0.4, 0.5])


@given(st.floats(0.001, 100), st.floats(0, 1e6), st.floats(0, 1e4))
def test_the_next_tick_lies_ahead_by_at_most_a_period(period: float, due: float, late: float) -> None:
    timer = Timer(period, nothing, due, due)
    timer.reschedule(due + late)
    assert due + late - 1e-6 <= timer.due <= due + late + period + 1e-6
    ticks = (timer.due - due) / period
    assert ticks == pytest.approx(round(ticks), abs=1e-4)


def test_two_timers_keep_their_own_time(loop: Loop, clock: Clock) -> None:
    ticks = []
    loop.every(0.1, lambda: ticks.append("fast"))
    loop.every(0.25, lambda: ticks.append("slow"))
    loop.run(until=clock.time + 0.55)
    assert (ticks.count("fast"), ticks.count("slow")) == (6, 3)


def test_an_alarm_fires_once_whenever_it_is_set(loop: Loop, clock: Clock) -> None:
    start, times = clock.time, []
    alarm = loop.alarm(lambda: times.append(clock.time - start))
    loop.run(until=start + 1)
    assert times == []
    for due in (1.5, 2.5):
        alarm.due = start + due
        loop.run(until=start + due + 0.5)
        assert alarm.due == FAR
    assert times == pytest.approx([1.5, 2.5])


def test_actions_run_in_the_order_they_were_called_in_each_after_a_look_around(waits: list[float]) -> None:
    done: list[str] = []
    loop = Loop(before_each=lambda: done.append("look"))
    for name in "abc":
        loop.call_soon(lambda name=name: done.append(name))
    loop.run_once()
    assert done == ["look", "a", "look", "b", "look", "c"]
    assert waits == [0]
    loop.close()


def test_an_action_called_by_an_action_waits_its_turn(loop: Loop) -> None:
    done = []
    loop.call_soon(lambda: (done.append("first"), loop.call_soon(lambda: done.append("later"))))
    loop.run_once()
    assert done == ["first"]
    loop.run_once()
    assert done == ["first", "later"]


def test_an_action_that_calls_itself_starves_no_timer(loop: Loop, clock: Clock) -> None:
    ticks = []

    def again() -> None:
        clock.pass_by(0.01)
        loop.call_soon(again)

    loop.call_soon(again)
    loop.every(0.1, lambda: ticks.append(clock.time))
    loop.run(until=clock.time + 0.55)
    assert len(ticks) == 6


def test_a_timer_made_by_a_timer_fires_too(loop: Loop, clock: Clock) -> None:
    done = []
    loop.alarm(lambda: loop.every(1.0, lambda: done.append("inner"))).due = clock.time
    loop.run(until=clock.time + 0.5)
    assert done == ["inner"]


def test_however_often_it_is_rung_the_bell_is_heard_once(loop: Loop) -> None:
    done = []
    for number in range(10_000):
        loop.call_soon(lambda number=number: done.append(number))
    assert real_select([loop._ear], [], [], 0)[0]
    loop.run_once()
    assert done == list(range(10_000))
    assert not real_select([loop._ear], [], [], 0)[0]
    loop.call_soon(nothing)
    assert real_select([loop._ear], [], [], 0)[0]


def test_a_file_that_can_be_read_runs_its_action_until_it_is_read(loop: Loop, pipe: tuple[int, int]) -> None:
    ear, mouth = pipe
    heard: list[bytes] = []
    loop.watch(ear, lambda: heard.append(os.read(ear, 1)))
    loop.run_once()
    assert heard == []
    os.write(mouth, b"ab")
    for _ in range(3):
        loop.run_once()
    assert heard == [b"a", b"b"]


def test_a_file_no_longer_watched_is_left_alone(loop: Loop, pipe: tuple[int, int]) -> None:
    loop.watch(pipe[0], pytest.fail)
    os.write(pipe[1], b"a")
    loop.unwatch(pipe[0])
    loop.unwatch(pipe[0])
    loop.run_once()


def test_an_action_may_end_the_watch_of_a_file_that_is_ready(loop: Loop, pipe: tuple[int, int]) -> None:
    ear, bell = os.pipe()
    try:
        loop.watch(ear, lambda: loop.unwatch(pipe[0]))
        loop.watch(pipe[0], pytest.fail)
        for end in (bell, pipe[1]):
            os.write(end, b"a")
        loop.run_once()
    finally:
        os.close(ear)
        os.close(bell)


def test_what_a_file_brings_is_done_in_the_same_round(loop: Loop, pipe: tuple[int, int]) -> None:
    done = []
    loop.watch(pipe[0], lambda: loop.call_next(lambda: done.append(os.read(pipe[0], 1))))
    os.write(pipe[1], b"a")
    loop.run_once()
    assert done == [b"a"]


def test_stop_ends_the_run_after_the_action_at_hand(loop: Loop, clock: Clock) -> None:
    done = []
    loop.call_soon(lambda: (loop.stop(), done.append("at hand")))
    loop.call_soon(lambda: done.append("next"))
    loop.every(0.1, lambda: done.append("tick"))
    loop.run()
    assert done == ["at hand"]


def test_stop_wakes_a_loop_that_waits(loop: Loop) -> None:
    loop.stop()
    assert real_select([loop._ear], [], [], 0)[0]


def test_with_nothing_to_do_it_waits_but_not_for_ever(loop: Loop, waits: list[float]) -> None:
    loop.run_once()
    assert waits == [LONGEST_WAIT]


def test_it_never_waits_beyond_the_time_given(loop: Loop, clock: Clock, waits: list[float]) -> None:
    loop.every(10.0, nothing)
    loop.run(until=clock.time + 2.5)
    assert max(waits) == pytest.approx(2.5)


def test_a_time_that_has_passed_still_does_what_is_ready(loop: Loop, clock: Clock) -> None:
    done: list[str] = []
    loop.call_soon(lambda: done.append("ready"))
    loop.run(until=clock.time)
    assert done == ["ready"]


def test_a_stop_ends_one_run_and_leaves_the_rest_to_the_next(loop: Loop) -> None:
    done: list[str] = []
    loop.call_soon(loop.stop)
    loop.call_soon(lambda: done.append("next"))
    loop.run()
    assert done == []
    loop.call_soon(loop.stop)
    loop.run()
    assert done == ["next"]


def test_an_error_ends_the_run_and_the_rest_waits_for_the_next(loop: Loop) -> None:
    done: list[str] = []
    fails: Callable[[], object] = lambda: 1 / 0  # noqa: E731
    loop.call_soon(fails)
    loop.call_soon(lambda: done.append("next"))
    with pytest.raises(ZeroDivisionError):
        loop.run_once()
    loop.run_once()
    assert done == ["next"]


def test_a_failure_elsewhere_comes_out_of_the_run(loop: Loop) -> None:
    loop.fail(ZeroDivisionError("an inbox is broken"))
    with pytest.raises(ZeroDivisionError, match="an inbox is broken"):
        loop.run()


def test_it_knows_since_when_it_is_awake_where_it_slept_beyond_its_time(
    loop: Loop, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def sleep_in(read: list[int], write: list[int], error: list[int], timeout: float) -> tuple:
        clock.pass_by(timeout + late)
        return [], [], []

    monkeypatch.setattr(select, "select", sleep_in)
    loop.every(1.0, nothing)
    for late in (0.4, 3.0):
        before = loop.awake_since
        loop.run_once()  # the first timer is due at once, the others in a second
        loop.run_once()
        assert (loop.awake_since == clock.time) is (late > 0.5)
        assert (loop.awake_since == before) is (late < 0.5)
    woke = loop.awake_since
    late = 0.0
    loop.run_once()
    assert loop.awake_since == woke


def test_an_action_that_takes_long_is_a_standstill_and_a_pause_between_two_runs_is_none(
    loop: Loop, clock: Clock
) -> None:
    loop.call_soon(lambda: clock.pass_by(3.0))
    loop.run(until=clock.time + 0.1)
    assert loop.awake_since == NEVER
    loop.call_soon(lambda: clock.pass_by(3.0))
    loop.run(until=clock.time + 3.1)
    assert loop.awake_since == clock.time - 0.1
    clock.pass_by(5.0)
    loop.run(until=clock.time + 0.1)
    assert loop.awake_since == clock.time - 5.2


def test_who_stood_still_knows_it_before_the_next_action(loop: Loop, clock: Clock) -> None:
    seen: list[float] = []
    loop.before_each = lambda: seen.append(loop.awake_since)
    loop.call_soon(lambda: clock.pass_by(3.0))
    loop.call_soon(nothing)
    loop.run_once()
    assert seen == [NEVER, clock.time]
