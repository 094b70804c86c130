import argparse
import os
import sys
from pathlib import Path

from zteleop.cli import VERBS
from zteleop.errors import ConfigError, nearest

EXAMPLES = (
    "zteleop run examples/publisher.py",
    "zteleop run pub_motor.py archangel",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", metavar="FILE", type=Path, help="a Python program")
    parser.add_argument(
        "words", metavar="WORD", nargs=argparse.REMAINDER, help="what the program is told, options as well"
    )


def run(arguments: argparse.Namespace) -> None:
    """Become the program, in the Python that zteleop is installed in: another may not know it."""
    check(arguments.file)
    os.execv(sys.executable, [sys.executable, str(arguments.file), *arguments.words])


def check(file: Path) -> None:
    """Raise ConfigError for what is no program, with what may have been meant."""
    if file.is_file():
        return
    if str(file) in VERBS:
        raise ConfigError(f"{file} is a verb of zteleop: say zteleop {file}")
    if file.is_dir():
        raise ConfigError(f"expected a Python program, found the folder {file}")
    there = [str(file.parent / one.name) for one in sorted(file.parent.glob("*.py"))]
    hint = nearest(str(file), there) if there else f"there is no Python program in {file.parent.resolve()}"
    raise ConfigError(f"there is no file {file}; {hint}")
