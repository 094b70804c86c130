import signal
import sys
import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.machine import signals


class Table(dict):
    """The process's signal handlers, as far as a test is concerned."""

    def __init__(self) -> None:
        super().__init__(dict.fromkeys(signals.ENDING, signal.SIG_DFL))
        self[signal.SIGINT] = signal.default_int_handler


@pytest.fixture
def handlers(monkeypatch: pytest.MonkeyPatch) -> Table:
    table = Table()
    monkeypatch.setattr(signals, "_raised", float("-inf"))
    monkeypatch.setattr(signal, "getsignal", table.__getitem__)
    monkeypatch.setattr(signal, "signal", table.__setitem__)
    return table


def test_every_ending_signal_unwinds_and_is_given_back(handlers: Table) -> None:
    before = Table()
    undo = signals.unwind()
    assert set(signals.ENDING) == {signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT}
    assert all(callable(handler) and handler not in before.values() for handler in handlers.values())
    undo()
    assert handlers == before


@pytest.mark.parametrize(
    ("number", "ending"),
    [
        (signal.SIGINT, KeyboardInterrupt(130)),
        (signal.SIGTERM, SystemExit(143)),
        (signal.SIGHUP, SystemExit(129)),
    ],
)
def test_a_signal_raises_and_a_second_one_does_not_disturb_for_a_while(
    handlers: Table, number: int, ending: BaseException, monkeypatch: pytest.MonkeyPatch
) -> None:
    signals.unwind()
    with pytest.raises(type(ending)) as error:
        handlers[number](number, None)
    assert error.value.args == ending.args
    for again in signals.ENDING:
        handlers[again](again, None)
    monkeypatch.setattr(signals, "UNDISTURBED", 0.0)
    with pytest.raises(type(ending)):
        handlers[number](number, None)


@pytest.mark.parametrize("theirs", [signal.SIG_IGN, lambda number, frame: None])
def test_what_somebody_handles_already_stays_theirs(handlers: Table, theirs: Any) -> None:
    handlers[signal.SIGTERM] = theirs
    undo = signals.unwind()
    assert handlers[signal.SIGTERM] is theirs
    undo()
    assert handlers[signal.SIGTERM] is theirs


def test_within_itself_it_changes_nothing(handlers: Table) -> None:
    outer: Callable[[], None] = signals.unwind()
    ours = dict(handlers)
    signals.unwind()()
    assert handlers == ours
    outer()


def test_only_the_main_thread_may_handle_signals(handlers: Table, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        signals, "threading", SimpleNamespace(current_thread=lambda: 1, main_thread=lambda: 2)
    )
    signals.unwind()()
    assert handlers == Table()


def test_ctrl_c_ends_a_program_quietly_and_is_still_what_people_catch(
    handlers: Table, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(signals, "UNDISTURBED", 0.0)
    signals.unwind()
    with pytest.raises(KeyboardInterrupt) as found:
        handlers[signal.SIGINT](signal.SIGINT, None)
    assert isinstance(found.value, SystemExit)
    assert found.value.code == 130
    monkeypatch.setattr(sys, "ps1", ">>> ", raising=False)
    with pytest.raises(KeyboardInterrupt) as found:
        handlers[signal.SIGINT](signal.SIGINT, None)
    assert not isinstance(found.value, SystemExit), "at a prompt the interpreter goes on"


def test_a_signal_in_a_shelter_raises_at_its_end(handlers: Table, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(signals, "UNDISTURBED", 0.0)
    signals.unwind()
    reached = []

    def work() -> None:
        with signals.sheltered():
            with signals.sheltered():
                handlers[signal.SIGINT](signal.SIGINT, None)
                reached.append("inner")
            reached.append("outer")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert reached == ["inner", "outer"]
    with signals.sheltered():
        pass  # it was told once


def test_a_signal_that_comes_while_a_thread_starts_is_raised_when_it_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Raised within Thread.start it would be lost in a RuntimeError of a lock that is not held."""
    begun = threading.Event()
    thread = threading.Thread(target=begun.set)
    really = thread.start

    def start_amid_a_signal() -> None:
        signals._raise(signal.SIGINT, None)
        really()

    monkeypatch.setattr(thread, "start", start_amid_a_signal)
    with pytest.raises(KeyboardInterrupt):
        signals.start(thread)
    assert begun.wait(5)
