"""How a program ends: an error is one sentence on stderr, and an exit code."""

import sys
from collections.abc import Callable

from zteleop.bus.escape import printable
from zteleop.errors import ZteleopError
from zteleop.machine import limits, signals


def in_words(program: str, act: Callable[[], int | None], *, debug: bool = False) -> int:
    """Do what a program does and return its exit code; a traceback only with `debug`."""
    undo_signals = signals.unwind()
    try:
        return act() or 0
    except BrokenPipeError:
        raise
    except ZteleopError as error:
        if debug:
            raise
        _tell(program, str(error))
        return error.exit_code
    except Exception as error:
        if debug:
            raise
        bug = f"{type(error).__name__}: {error} (a bug; --debug shows where)"
        _tell(program, limits.reached(error) or bug)
        return 1
    finally:
        undo_signals()


def _tell(program: str, words: str) -> None:
    sys.stderr.write(printable(f"{program}: {words}\n", keep="\n"))
