from typing import Any

from zteleop.terminal.keys import ESCAPE_WAIT
from zteleop.terminal.typed import Typed
from zteleop.testing import FakeTerminal


def test_keys_come_by_their_names_and_a_lone_escape_after_a_while() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"a\x1b[A\x1b"
    assert typed.read(1.0) == ["a", "up"]
    assert typed.read(1.0 + ESCAPE_WAIT) == ["escape"]


def test_a_key_half_received_is_forgotten_over_a_suspension() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"\x1b["
    assert typed.read(1.0) == []
    typed.suspend()
    terminal.typed = b"A"
    assert typed.read(1.0) == ["A"]


def test_a_process_that_was_stopped_and_went_on_says_so_once() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    assert not typed.went_on()
    terminal.resumed += 1
    assert [typed.went_on(), typed.went_on()] == [True, False]
    typed.suspend()  # which whoever asked for it knows
    assert not typed.went_on()


def test_a_terminal_that_hung_up_has_ended_and_its_last_key_counts() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"\x1b"
    assert (typed.read(1.0), typed.ended) == ([], False)
    terminal.gone = True
    assert (typed.read(1.0 + ESCAPE_WAIT), typed.ended) == (["escape"], True)
