"""Runs a program that a watchdog starts: `python -m zteleop.processes NAME FILE...`, the files inherited."""

import signal
import sys
from importlib import import_module

from zteleop.errors import ConfigError
from zteleop.processes import PROGRAMS
from zteleop.processes.ending import in_words


def main(arguments: list[str]) -> int:
    """Run one program; return its exit code."""
    signal.signal(signal.SIGTSTP, signal.SIG_IGN)  # its watchdog says why
    try:
        return in_words("zteleop actuator", lambda: _run(*arguments))  # which is what somebody typed
    except KeyboardInterrupt:
        return 130


def _run(name: str = "", *files: str) -> int:
    if name not in PROGRAMS or name == "watchdog" or not all(file.isdecimal() for file in files):
        raise ConfigError("a watchdog runs this, with files of its own; zteleop actuator starts everything")
    code: int = import_module(f"zteleop.processes.{name}").run(*map(int, files))
    return code


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
