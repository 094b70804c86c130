import argparse
from contextlib import suppress

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._checkup import CHECKS
from zteleop.cli._patient import Patient
from zteleop.cli._salvage import salvage
from zteleop.errors import DeviceError
from zteleop.terminal.terminal import find_terminal

EXAMPLES = ("zteleop doctor", "zteleop doctor --robot archangel")
MARKS = {True: "good", False: "WRONG", None: "-"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each check; return 1 when something hinders."""
    settings, wrong = salvage(arguments.config)
    terminal = None
    with suppress(DeviceError):
        terminal = find_terminal()
    patient = Patient(_options.with_typed(arguments, settings), wrong, terminal)
    hinders = 0
    for name, check in CHECKS.items():
        good, words = check(patient)
        hinders += good is False
        print(printable(f"{MARKS[good]:6} {name:10} {words}"), flush=True)
    print(f"\n{hinders} thing{'s'[: hinders - 1]} to mend" if hinders else "\nnothing hinders")
    return 1 if hinders else 0
