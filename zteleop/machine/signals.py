"""A signal that ends a process unwinds every `with` first, undisturbed: the last word is neutral."""

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

ENDING = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT") if hasattr(signal, name)
)
"""Ctrl-C, kill, a terminal that closes, Ctrl-\\."""
UNDISTURBED = 1.0
"""s after a signal in which a second Ctrl-C does not end what the first began to clean up."""
_raised = float("-inf")
_shelters = 0
_kept: int | None = None
"""A signal that came in a shelter."""
_DEFAULTS = (signal.SIG_DFL, signal.default_int_handler)


class Interrupted(SystemExit, KeyboardInterrupt):
    """Ctrl-C, for whoever catches that; a program that does not ends by it without a traceback."""


def unwind() -> Callable[[], None]:
    """Make the ending signals raise, where nobody handles them yet; return what undoes it."""
    if threading.current_thread() is not threading.main_thread():
        return lambda: None
    before: dict[int, Any] = {number: signal.getsignal(number) for number in ENDING}
    ours = {number: handler for number, handler in before.items() if handler in _DEFAULTS}
    for number in ours:
        signal.signal(number, _raise)

    def undo() -> None:
        for number, handler in ours.items():
            signal.signal(number, handler)

    return undo


@contextmanager
def sheltered() -> Iterator[None]:
    """Let an ending signal wait until the end of this.

    What a handler raises in Python code that is called from C may be lost: msgspec, while it makes a decoder,
    hashes types of `typing`, and drops whatever that raises.
    """
    global _shelters, _kept
    if threading.current_thread() is not threading.main_thread():  # which alone handles signals
        yield
        return
    _shelters += 1
    try:
        yield
    finally:
        _shelters -= 1
        if _kept is not None:  # within another shelter it is kept again
            number, _kept = _kept, None
            _raise(number, None)


def start(thread: threading.Thread) -> None:
    """Start a thread; an ending signal waits until it runs.

    Thread.start waits in a Condition, which has given its lock away for that: what a handler raises before
    the lock is back is lost in "release unlocked lock".
    """
    with sheltered():
        thread.start()


def _raise(number: int, frame: FrameType | None) -> None:
    global _raised, _kept
    if _shelters:
        _kept = number
        return
    now = time.monotonic()
    if now - _raised < UNDISTURBED:
        return
    _raised = now
    if number == signal.SIGINT:
        # At a prompt an exit would end the interpreter, and with it what was typed so far.
        raise KeyboardInterrupt if hasattr(sys, "ps1") else Interrupted(128 + number)
    raise SystemExit(128 + number)


def stay(tell: Callable[[], object]) -> None:
    """Let Ctrl-Z stop nothing; `tell` is called within the handler."""
    signal.signal(signal.SIGTSTP, lambda *_: tell())


def ending(code: int | None) -> str:
    """Return by which signal a process with this exit code ended, in words; nothing where by none."""
    return f", by {signal.Signals(-code).name}" if code and code < 0 else ""
