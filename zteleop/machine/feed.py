"""A program whose output is read piece by piece; one whose reader was killed ends by its next write."""

import os
import subprocess
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress

from zteleop.machine import signals

PIECE = 2**16
ENDS_WITHIN = 2.0
"""s to end by itself"""


class Feed:
    """Runs a program; `take` has what it writes, and `ended` is called once, both in a thread.

    Raises FileNotFoundError where there is no such program.
    """

    def __init__(
        self, command: Sequence[str], take: Callable[[bytes], object], ended: Callable[[], object]
    ) -> None:
        self._take = take
        self._ended = ended
        self._words = ""
        # In a session of its own, so that no key of a terminal ends it before this process asks it to.
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._readers = [threading.Thread(target=run, daemon=True) for run in (self._listen, self._read)]
        for reader in self._readers:
            signals.start(reader)

    @property
    def last_words(self) -> str:
        """What the program complained of last."""
        return self._words

    def close(self) -> None:
        """End the program, and return when it has ended."""
        self._process.terminate()
        try:
            self._process.wait(ENDS_WITHIN)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        for reader in self._readers:
            reader.join()

    def _read(self) -> None:
        output = self._process.stdout
        assert output
        with suppress(OSError), output:
            while piece := os.read(output.fileno(), PIECE):
                self._take(piece)
        self._process.wait()
        self._readers[0].join(ENDS_WITHIN)  # what it complained of comes before its end
        self._ended()

    def _listen(self) -> None:
        errors = self._process.stderr
        assert errors
        with suppress(OSError), errors:
            for line in errors:
                self._words = line.decode(errors="replace").strip() or self._words
