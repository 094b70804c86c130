from typing import Any

from zteleop.terminal.keys import ESCAPE_WAIT, Key
from zteleop.terminal.releases import ASK
from zteleop.terminal.typed import Typed
from zteleop.testing import FakeTerminal


def test_keys_come_by_their_names_and_a_lone_escape_after_a_while() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"a\x1b[A\x1b"
    assert typed.read(1.0) == [Key("a"), Key("up", place="up")]
    assert typed.read(1.0 + ESCAPE_WAIT) == [Key("escape")]


def test_a_key_half_received_is_forgotten_over_a_suspension() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"\x1b["
    assert typed.read(1.0) == []
    typed.suspend(1.0)
    terminal.typed = b"A"
    assert typed.read(1.0) == [Key("A")]


def test_a_process_that_was_stopped_and_went_on_says_so_once() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    assert not typed.went_on(1.0)
    terminal.resumed += 1
    assert [typed.went_on(1.0), typed.went_on(1.0)] == [True, False]
    typed.suspend(1.0)  # which whoever asked for it knows
    assert not typed.went_on(1.0)


def test_a_terminal_that_hung_up_has_ended_and_its_last_key_counts() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"\x1b"
    assert (typed.read(1.0), typed.ended) == ([], False)
    terminal.gone = True
    assert (typed.read(1.0 + ESCAPE_WAIT), typed.ended) == ([Key("escape")], True)


def test_a_terminal_is_asked_at_the_first_read_and_whenever_it_was_away() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    for times in (1, 1):
        typed.read(1.0)
        assert terminal.said == ASK * times
    terminal.typed = b"\x1b[?15uw"
    assert typed.read(1.0) == [Key("w")]
    assert typed.releases.told
    typed.suspend(2.0)
    assert not typed.releases.told
    terminal.resumed += 1
    assert typed.went_on(3.0)
    assert terminal.said == ASK * 3


def test_bytes_of_any_kind_show_that_the_terminal_is_there() -> None:
    terminal: Any = FakeTerminal()
    typed = Typed(terminal)
    terminal.typed = b"\x1b[?15u"
    typed.read(1.0)
    assert typed.releases.is_silent(2.0)
    terminal.typed = b"w"
    typed.read(2.0)
    assert not typed.releases.is_silent(2.1)
