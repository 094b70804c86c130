"""Runs one verb: its arguments, its errors in one sentence, its exit code."""

import argparse
import io
import sys
from importlib import import_module

from zteleop.cli import file_of
from zteleop.processes.ending import in_words


def run_verb(verb: str, text: str, arguments: list[str]) -> int:
    """Run a verb and return its exit code; a traceback only with --debug."""
    if isinstance(sys.stdout, io.TextIOWrapper):  # what a terminal cannot show must not end what shows it
        sys.stdout.reconfigure(errors="backslashreplace")
    module = import_module(f"zteleop.cli.{file_of(verb)}")
    parser = argparse.ArgumentParser(
        prog=f"zteleop {verb}",
        description=f"{text[0].upper()}{text[1:]}.",
        epilog="\n  ".join(["examples:", *module.EXAMPLES]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    module.add_arguments(parser)
    options = parser.parse_args(arguments)
    return in_words(f"zteleop {verb}", lambda: module.run(options), debug=options.debug)
