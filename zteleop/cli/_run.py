"""Runs one verb: its arguments, its errors in one sentence, its exit code."""

import argparse
import io
import re
import sys
from importlib import import_module
from typing import NoReturn

from zteleop.cli import file_of
from zteleop.errors import meant
from zteleop.processes.ending import in_words
from zteleop.text.quantity import KINDS

UNITS = {unit for kind in KINDS.values() for unit in kind.units}
WHERE = {
    "topic": "zteleop list shows those there are",
    "node": "zteleop node list shows those there are",
    "service": "zteleop service list shows those there are",
}
"""what a verb wants to be told -> where to find it"""
_BACKWARDS = re.compile(r"-[\d.]+[a-z°/]+")
"""A measure such as -0.2m/s, which argparse would take for an option."""
OF_ROS = {
    "--qos": "of QoS there is nothing to choose here",
    "--no-daemon": "there is no daemon; whoever is on the bus is asked",
    "--spin-time": "there is no wait to choose; whoever is on the bus is asked",
    "--include-hidden": "all topics and nodes are shown as it is",
    "--wait-matching": "it waits for whoever hears by itself, for a moment",
    "--keep-alive": "what is said once is heard by whoever is there; -r says it again and again",
    "--print": "each message is printed",
    "--use-sim-time": "all go by one clock",
}
"""how options begin that are typed out of habit -> what to know instead"""


class Parser(argparse.ArgumentParser):
    """One that says, of a word that is missing, where to find it."""

    def error(self, message: str) -> NoReturn:
        rest = {one.metavar or one.dest for one in self._actions if one.nargs == argparse.REMAINDER}
        head, required, names = message.rpartition("required: ")
        missing = [name for name in names.split(", ") if name not in rest]
        if required:
            message = f"{head}{required}{', '.join(missing)}"
        if choice := re.search(r"(.*): invalid choice: '(.*)' \(choose from (.*)\)", message):
            known = re.findall(r"[\w./-]+", choice[3])
            message = (
                f"{choice[1]}: expected {' or '.join(known)}, found {choice[2]}{_near(choice[2], known)}"
            )
        where = WHERE.get(next(iter(missing), ""), "")
        super().error(f"{message}; {where}" if where else message)


def _near(word: str, known: list[str]) -> str:
    question = meant(word, known)
    return f"; {question}" if question else ""


def run_verb(verb: str, text: str, arguments: list[str]) -> int:
    """Run a verb and return its exit code; a traceback only with --debug."""
    if isinstance(sys.stdout, io.TextIOWrapper):  # what a terminal cannot show must not end what shows it
        sys.stdout.reconfigure(errors="backslashreplace")
    module = import_module(f"zteleop.cli.{file_of(verb)}")
    parser = Parser(
        prog=f"zteleop {verb}",
        description=f"{text[0].upper()}{text[1:]}.",
        epilog="\n  ".join(["examples:", *module.EXAMPLES]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    module.add_arguments(parser)
    words = [f" {word}" if _BACKWARDS.fullmatch(word) else word for word in arguments]
    options, unknown = parser.parse_known_args(words)
    if unknown:
        parser.error(_unknown(unknown, parser))
    return in_words(f"zteleop {verb}", lambda: module.run(options), debug=options.debug)


def _unknown(words: list[str], parser: argparse.ArgumentParser) -> str:
    """Return what is wrong with words that a verb does not take, and which of its options was meant."""
    from difflib import get_close_matches

    option = next((word.partition("=")[0] for word in words if word.startswith("-") and word != "--"), "")
    if known := next((told for begin, told in OF_ROS.items() if option.startswith(begin)), ""):
        return f"no option {option}: {known}"
    typed = option if option.startswith("--") else ""
    options = {word for word in parser.format_help().replace(",", " ").split() if word.startswith("--")}
    if typed in options:
        return f"{typed} stands behind --, where all is taken as it is; write it before that"
    if typed and (near := get_close_matches(typed, sorted(options), 1, 0.8)):
        return f"no option {typed}; did you mean {near[0]}?"
    if option:
        return f"no option {option}; {parser.prog} --help shows those there are"
    if words[0] in UNITS:
        return f"{words[0]} stands alone; write number and unit together, such as 50cm"
    return f"unrecognized arguments: {' '.join(words)}"
