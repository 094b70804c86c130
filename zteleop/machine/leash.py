"""A process that ends with this one, however this one ends: it is held by a pipe."""

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

ENDS_WITHIN = 3.0
"""s to end by itself"""
Process = subprocess.Popen[bytes]


@contextmanager
def leashed(arguments: Sequence[str], log: IO[str], environment: Mapping[str, str]) -> Iterator[Process]:
    """Run a verb that ends when its standard input does; what it says goes to a file."""
    process = subprocess.Popen(
        [sys.executable, "-m", "zteleop", *arguments, "--with-parent"],
        stdin=subprocess.PIPE,
        stdout=log,
        stderr=subprocess.STDOUT,
        start_new_session=True,
        env={**os.environ, **environment},
    )
    try:
        yield process
    finally:
        assert process.stdin
        process.stdin.close()
        try:
            process.wait(ENDS_WITHIN)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def last_words(log: Path) -> str:
    """Return the last line that a process has said into a file."""
    lines = log.read_text().strip().splitlines()
    return lines[-1] if lines else "it said nothing"
