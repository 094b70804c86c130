"""Runs one verb: its arguments, its errors in one sentence, its exit code."""

import argparse
import io
import sys
from importlib import import_module

from zteleop.bus.escape import printable
from zteleop.errors import ZteleopError
from zteleop.machine import limits, signals


def run_verb(verb: str, text: str, arguments: list[str]) -> int:
    """Run a verb and return its exit code; a traceback only with --debug."""
    if isinstance(sys.stdout, io.TextIOWrapper):  # what a terminal cannot show must not end what shows it
        sys.stdout.reconfigure(errors="backslashreplace")
    module = import_module(f"zteleop.cli.{verb}")
    parser = argparse.ArgumentParser(prog=f"zteleop {verb}", description=f"{text[0].upper()}{text[1:]}.")
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    module.add_arguments(parser)
    options = parser.parse_args(arguments)
    undo_signals = signals.unwind()
    try:
        return module.run(options) or 0
    except BrokenPipeError:
        raise
    except ZteleopError as error:
        if options.debug:
            raise
        _say(verb, str(error))
        return error.exit_code
    except Exception as error:
        if options.debug:
            raise
        _say(verb, limits.reached(error) or f"{type(error).__name__}: {error} (a bug; --debug shows where)")
        return 1
    finally:
        undo_signals()


def _say(verb: str, words: str) -> None:
    print(printable(f"zteleop {verb}: {words}", keep="\n"), file=sys.stderr)
