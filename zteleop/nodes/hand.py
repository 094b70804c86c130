"""The watchdog's own way to the chip: it reads, brings to rest, and cuts, whoever else writes."""

from collections.abc import Callable, Mapping
from contextlib import suppress

from zteleop.bus import clock
from zteleop.control.deadlines import BLIND
from zteleop.control.judge import Judge
from zteleop.drivers import PulseDriver
from zteleop.errors import DeviceError

MISSES = 2
"""in a row besides, until the outputs of a chip are cut that nobody can read"""
YIELD = 5
"""times as long as a look took, until the next one: on a slow bus whoever writes comes first"""


class Hand:
    """A chip that somebody else drives."""

    def __init__(self, chip: PulseDriver, enable: Callable[[bool], bool], judge: Judge) -> None:
        self._chip = chip
        self._judge = judge
        self._enable = enable
        """Lets the chip's outputs through, or cuts them; says whether a pin did."""
        self._neutral_us = judge.neutral_us
        self.is_cut = True
        self.pin_cuts = False
        """No pulse leaves the chip, whatever it was told."""
        self.at_rest = False
        """It read back neutral when it was last brought to rest."""
        self.trouble = ""
        """Why it cannot be read."""
        self.took = 0.0
        """s of the last look"""
        self.seen = clock.now()
        self._look_after = clock.now()
        self._missed = 0

    def is_due(self, now: float) -> bool:
        """Say whether it may be looked at again."""
        return now >= self._look_after

    def look(self) -> Mapping[int, float | None]:
        """Read its pulses, in us; raises DeviceError."""
        began = clock.now()
        try:
            found = self._chip.read(self._neutral_us)
        except DeviceError as error:
            self.trouble = str(error)
            raise
        finally:
            self.took = clock.now() - began
            self._look_after = began + YIELD * self.took
        self.seen, self._missed, self.trouble = clock.now(), 0, ""
        return found

    def miss(self) -> bool:
        """Count a look that failed, and cut what is blind for too long; True when a pin does that now."""
        self._missed += 1
        if self._missed < MISSES or clock.now() - self.seen <= BLIND or self.is_cut:
            return False
        self.cut(True)
        return self.pin_cuts

    def let_through(self) -> None:
        """Let the outputs through to whoever drives the chip from now on."""
        self.seen, self._missed = clock.now(), 0
        self.cut(False)

    def cut(self, cut: bool) -> None:
        self.is_cut = cut
        self.pin_cuts = self._enable(not cut) and cut

    def write_neutral(self) -> None:
        """Write neutral, once; it may be what comes next that gets through."""
        with suppress(DeviceError):
            self._chip.write(self._neutral_us)

    def rest(self, at_once: bool) -> str:
        """Read neutral back, and bring up a chip that does not hold it; else cut its outputs.

        Write first where that is `at_once`: a chip that another program left running may have another
        period. Return what went wrong.
        """
        trouble = ""
        if at_once:
            self.write_neutral()
        try:
            self.at_rest = self._reads_neutral()
            if not self.at_rest:
                self._chip.start(self._neutral_us)
                self.at_rest = self._reads_neutral()
        except DeviceError as error:
            self.at_rest, trouble = False, str(error)
        if not self.at_rest:
            self.cut(True)
        return trouble

    def close(self) -> None:
        self.cut(True)
        self._chip.close()

    def _reads_neutral(self) -> bool:
        return self._judge.at_rest(self._chip.read(self._neutral_us))
