"""Says what a camera sees: the newest picture only, and no more of them than the slowest link takes."""

from collections.abc import Callable, Sequence

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.cameras import Source, Wanted
from zteleop.cameras.jpegs import Jpegs
from zteleop.control.proof import NEVER
from zteleop.errors import DeviceError
from zteleop.machine.backoff import BackOff
from zteleop.machine.feed import Feed
from zteleop.messages import CompressedImage, Header, Time

TOPIC = "camera/image/compressed"
SLOWEST_RATE, FASTEST_RATE = 0.5, 60.0
"""pictures a second"""
STARTS_WITHIN, FROZEN_AFTER = 5.0, 2.0
"""s until a camera's first picture, and without another after which it is started anew"""
LOOK_EVERY, COUNT_EVERY = 0.2, 2.0
LONGEST_GAP = 1.0
"""s between two pictures on any link: one that takes nothing now may take the next"""
EARLY = 0.1
"""of a period by which a picture may come early: cameras and this clock do not go by one"""


class Pace:
    """Decides which pictures are said; times in s, `unsent` and `length` in bytes."""

    def __init__(self) -> None:
        self._last = NEVER
        self.said = 0
        self.held_back = 0
        """for a link that is full"""

    def takes(self, now: float, rate: float, unsent: int, length: int) -> bool:
        """Say whether a picture is said now: not before the one before it has left, or nearly."""
        gap = now - self._last
        if gap < (1 - EARLY) / rate:
            return False
        if unsent > length / 2 and gap < LONGEST_GAP:
            self.held_back += 1
            return False
        self._last = now
        self.said += 1
        return True

    def count(self) -> tuple[int, int]:
        """Return how many were said and held back since the last count."""
        counted, self.said, self.held_back = (self.said, self.held_back), 0, 0
        return counted


class Running:
    """A source that runs: its pictures come in a thread, and the newest waits to be taken."""

    def __init__(self, source: Source, tell: Callable[[], object]) -> None:
        self.shows = source.shows
        self.began = clock.now()
        self.last = self.began
        self.gave = False
        self.over = False
        self._tell = tell
        self._jpegs = Jpegs()
        self._newest: tuple[Time, bytes] | None = None
        self._feed = Feed(source.command, self._take, self._end)

    @property
    def wrong(self) -> str:
        """Why it gives no picture now; nothing while it does."""
        if self.over:
            return self._feed.last_words or "its program has ended"
        silent = clock.now() - self.last
        return f"no picture for {silent:.0f} s" if silent > self.patience else ""

    @property
    def patience(self) -> float:
        return FROZEN_AFTER if self.gave else STARTS_WITHIN

    def newest(self) -> tuple[Time, bytes] | None:
        """Return the newest picture, and when it came; None when it was taken already."""
        newest, self._newest = self._newest, None
        return newest

    def close(self) -> None:
        self._feed.close()

    def _take(self, piece: bytes) -> None:
        for picture in self._jpegs.take(piece):
            self._newest = clock.stamp(), picture
            self.last, self.gave = clock.now(), True
            self._tell()

    def _end(self) -> None:
        self.over = True
        self._tell()


class Photographer:
    """Runs one source after another until one gives pictures, and that one again whenever it ends."""

    def __init__(
        self,
        node: Node,
        make: Callable[[Wanted], Sequence[Source]],
        wanted: Wanted,
        unsent: Callable[[], int],
    ) -> None:
        self._node = node
        self._make = make
        self._wanted = wanted
        self._unsent = unsent
        self._pictures = node.publisher(TOPIC, CompressedImage)
        self._pace = Pace()
        self._backoff = BackOff()
        self._place = 0
        """of the source that is tried, or has worked"""
        self._works = False
        self._slow = False
        self._faults = list[str]()
        self._running: Running | None = None
        self._again = NEVER
        self._rate = node.parameter(
            "rate",
            float(wanted.rate),
            "pictures a second that are said, at most",
            least=SLOWEST_RATE,
            most=FASTEST_RATE,
        )
        node.parameter(
            "quality",
            wanted.quality,
            "of a JPEG that is made here; a camera that makes its own has its own",
            least=1,
            most=100,
            changed=self._set_quality,
        )
        node.every(LOOK_EVERY)(self.look)
        node.every(COUNT_EVERY)(self._count)

    def close(self) -> None:
        """End what runs."""
        if self._running:
            self._running.close()
            self._running = None

    def look(self) -> None:
        """Take in what has come, and begin anew what has ended; raises DeviceError when no source works."""
        running = self._running
        if running is None:
            if clock.now() >= self._again:
                self._begin()
        elif picture := running.newest():
            self._say(running, *picture)
        elif wrong := running.wrong:
            self._fail(running.shows, wrong, clock.now() - running.began)

    def _begin(self) -> None:
        sources = self._make(self._wanted)
        if self._place >= len(sources):
            raise DeviceError(f"no camera gives a picture: {'; '.join(dict.fromkeys(self._faults))}")
        source = sources[self._place]
        try:
            self._running = Running(source, lambda: self._node.membership.loop.call_soon(self.look))
        except FileNotFoundError:
            self._fail(source.shows, f"{source.command[0]} is not installed", 0.0)

    def _say(self, running: Running, stamp: Time, picture: bytes) -> None:
        if not self._works:
            self._works = True
            self._node.log.info(f"says what {running.shows} shows, on {self._node.robot}/{TOPIC}")
        if self._pace.takes(clock.now(), self._rate.value, self._unsent(), len(picture)):
            self._pictures.publish(CompressedImage(Header(stamp, "camera"), "jpeg", picture))

    def _fail(self, shows: str, wrong: str, lived: float) -> None:
        self.close()
        if self._works:
            self._node.log.warn(f"{shows} gives no picture any more: {wrong}; it is started anew", "camera")
            self._again = clock.now() + self._backoff.pause(lived)
        else:
            self._faults.append(f"{shows}: {wrong}")
            self._place += 1

    def _set_quality(self, quality: int) -> None:
        self._wanted = self._wanted._replace(quality=quality)
        self.close()

    def _count(self) -> None:
        said, held_back = self._pace.count()
        if held_back > said and not self._slow:
            self._slow = True
            self._node.log.warn(
                f"the slowest link takes {said / COUNT_EVERY:.1f} pictures a second: a smaller --size, or "
                "less --quality, makes more of them"
            )
        elif self._slow and not held_back:
            self._slow = False
            self._node.log.info("every link takes all pictures again")
