"""One JPEG after another, out of a stream that says nowhere how long each is.

After ITU T.81: a picture begins with SOI; segments with their lengths follow, which may hold pictures of
their own; from the first scan on, an FF that is no marker has a 00 behind it, so the first FF D9 is the end.
"""

from collections.abc import Iterator

LONGEST = 2**20
"""bytes of a picture: more is told to no page"""
SOI, EOI, SOS = b"\xff\xd8\xff", b"\xff\xd9", 0xDA


class Jpegs:
    """Takes pieces as they come, and returns the pictures that are whole."""

    def __init__(self) -> None:
        self._rest = b""
        self.dropped = 0
        """how often something was none, or too long"""

    def take(self, piece: bytes) -> Iterator[bytes]:
        """Yield the pictures that end in this piece."""
        self._rest += piece
        while (begin := self._rest.find(SOI)) >= 0:
            self.dropped += begin > 0
            self._rest = self._rest[begin:]
            end, is_whole = _end(self._rest)
            if end == 0:
                break
            if is_whole:
                yield self._rest[:end]
            self.dropped += not is_whole
            self._rest = self._rest[end:]
        else:
            self._rest = self._rest[-2:]  # of which the first may begin
        if len(self._rest) > LONGEST:
            self._rest, self.dropped = b"", self.dropped + 1


def _end(data: bytes) -> tuple[int, bool]:
    """Return where the picture ends that data begins with, and whether it is whole; 0 while it goes on."""
    at = 2
    while at + 4 <= len(data):
        if data[at] != 0xFF:
            return 2, False
        if data[at + 1] == 0xFF:  # fills
            at += 1
        elif data[at + 1] != SOS:
            at += 2 + int.from_bytes(data[at + 2 : at + 4])
        else:
            end, other = data.find(EOI, at), data.find(SOI, at)
            is_cut = other >= 0 and not 0 <= end < other  # another begins before this one ends
            return (other, False) if is_cut else (end + 2 if end >= 0 else 0, True)
    return 0, False
