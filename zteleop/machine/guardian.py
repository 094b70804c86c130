"""Gives a terminal back after a program that was killed: a process held by a pipe, which outlives it."""

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress

SCRIPT = """
trap '' INT HUP TERM QUIT TSTP TTOU TTIN
modes=$(stty -g <"$1") || exit 1
echo ready
read -r farewell && exit
case $(stty -a <"$1") in *-isig*) stty "$modes" <"$1" ;; esac
printf %s "$2" >"$1"
"""
"""A shell takes a tenth of a Python's memory. TTOU: whoever is in the background may not set a terminal.

Signals by keys are off in no shell's modes: where they are on again, a shell has set the terminal back.
"""


@contextmanager
def guarded(terminal: str, words: str) -> Iterator[None]:
    """Set the modes of a terminal back, and write these words to it, if this process dies in here.

    Enter it before any mode is changed. Without a shell, or a terminal it can open, nobody guards.
    """
    try:
        guardian = subprocess.Popen(
            ["/bin/sh", "-c", SCRIPT, "guardian", terminal, words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
            process_group=0,  # a key of the terminal ends us, and not it
        )
    except OSError:
        yield
        return
    with guardian:
        assert guardian.stdin
        assert guardian.stdout
        guardian.stdout.readline()  # it has seen the modes as they were, or is gone
        try:
            yield
        finally:
            with suppress(BrokenPipeError):
                guardian.stdin.write(b"farewell\n")
