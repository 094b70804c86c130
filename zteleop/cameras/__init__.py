"""Where pictures come from: programs that write one JPEG after another. One kind of camera, one line here.

What drives a camera, and what encodes a picture, others keep well: `rpicam-vid` on a Raspberry Pi, `ffmpeg`
for any other. A camera that makes JPEGs itself is copied, and not encoded anew.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

_QUIET = ("-hide_banner", "-loglevel", "error", "-nostdin", "-fflags", "nobuffer")
_OUT = ("-f", "mjpeg", "-flush_packets", "1", "pipe:1")


class Wanted(NamedTuple):
    """What pictures are to be like."""

    width: int = 640
    height: int = 480
    rate: int = 20
    """a second"""
    quality: int = 80
    """1 to 100, where somebody encodes here; a camera that does so itself has its own"""

    @property
    def size(self) -> str:
        return f"{self.width}x{self.height}"


class Source(NamedTuple):
    """A program that writes pictures to its standard output, and what it shows."""

    shows: str
    command: tuple[str, ...]


def sources(device: str | None, wanted: Wanted) -> list[Source]:
    """Return what may give pictures of a device, the best first; without one, of any camera there is."""
    if device is None:
        return [source for kind in REAL for source in CAMERAS[kind](None, wanted)]
    if device in CAMERAS:
        return list(CAMERAS[device](None, wanted))
    return list((_v4l2 if device.startswith("/dev/") else _film)(device, wanted))


def _rpicam(_: str | None, wanted: Wanted) -> Iterator[Source]:
    size = ("--width", f"{wanted.width}", "--height", f"{wanted.height}", "--framerate", f"{wanted.rate}")
    how = ("--timeout", "0", "--nopreview", "--codec", "mjpeg", "--quality", f"{wanted.quality}", "--flush")
    yield Source("the Pi's camera", ("rpicam-vid", *how, *size, "--output", "-"))


def _v4l2(device: str | None, wanted: Wanted) -> Iterator[Source]:
    there = sorted(map(str, Path("/dev").glob("video*")), key=lambda one: (len(one), one))
    for one in [device] if device else there:
        reads = ("-framerate", f"{wanted.rate}", "-video_size", wanted.size, "-i", one)
        own = ("-f", "v4l2", "-input_format", "mjpeg", *reads, "-c:v", "copy")
        yield Source(one, ("ffmpeg", *_QUIET, *own, *_OUT))
        yield Source(one, ("ffmpeg", *_QUIET, "-f", "v4l2", *reads, *_encoded(wanted), *_OUT))


def _test(_: str | None, wanted: Wanted) -> Iterator[Source]:
    reads = ("-re", "-f", "lavfi", "-i", f"testsrc=size={wanted.size}:rate={wanted.rate}")
    yield Source("the test picture", ("ffmpeg", *_QUIET, *reads, *_encoded(wanted), *_OUT))


def _film(file: str | None, wanted: Wanted) -> Iterator[Source]:
    reads = ("-re", "-stream_loop", "-1", "-i", f"file:{file}")
    shape = ("-r", f"{wanted.rate}", "-s", wanted.size, "-an")
    yield Source(f"film {file}", ("ffmpeg", *_QUIET, *reads, *shape, *_encoded(wanted), *_OUT))


def _encoded(wanted: Wanted) -> tuple[str, ...]:
    """Return how to encode: ffmpeg counts from 2, the best, to 31."""
    return ("-c:v", "mjpeg", "-q:v", f"{2 + round((100 - wanted.quality) * 29 / 99)}")


CAMERAS: dict[str, Callable[[str | None, Wanted], Iterator[Source]]] = {
    "rpicam": _rpicam,
    "v4l2": _v4l2,
    "test": _test,
}
"""kind -> what may give pictures of such a camera, by the name of a device or of any"""
REAL = ("rpicam", "v4l2")
"""which may be there without being asked for"""
