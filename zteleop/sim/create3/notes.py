"""The notes a Create 3 plays, one after the other."""

from collections import deque

from zteleop.messages import AudioNote, AudioNoteVector

MOST = 1000
"""notes that wait"""


class Notes:
    """A queue of notes; `started` says of each when it begins, for whoever empties it."""

    def __init__(self) -> None:
        self._waiting: deque[AudioNote] = deque()
        self._left = 0.0
        self.playing: AudioNote | None = None
        self.started: deque[AudioNote] = deque(maxlen=MOST)

    def hear(self, message: AudioNoteVector) -> None:
        """Play notes after those that wait, or instead of them."""
        if not message.append:
            self._waiting.clear()
            self.playing, self._left = None, 0.0
        room = MOST - len(self._waiting)
        self._waiting.extend(message.notes[:room])

    def step(self, dt: float) -> None:
        """Let `dt` s pass."""
        if self.playing:
            self._left -= dt
        while self._left <= 0 and (self.playing or self._waiting):
            self._next()

    def _next(self) -> None:
        if not self._waiting:
            self.playing, self._left = None, 0.0
            return
        self.playing = self._waiting.popleft()
        self._left += runtime(self.playing)
        self.started.append(self.playing)


def runtime(note: AudioNote) -> float:
    """s"""
    return max(0.0, note.max_runtime.sec + note.max_runtime.nanosec / 1e9)
