"""The chip, never trusted: what fails is written again, what was forgotten is noticed and repaired."""

import time
from collections.abc import Callable, Mapping
from contextlib import suppress

from zteleop.bus import clock
from zteleop.control.drive import Drive
from zteleop.control.evidence import Evidence
from zteleop.control.slowness import SLOW, Slowness
from zteleop.drivers import PulseDriver
from zteleop.drivers.registers import CHANNELS
from zteleop.errors import DeviceError
from zteleop.messages import Confirmed

FAILED_STEPS = 3
"""in a row that make a fault; each has written three times already"""
REPAIR_EVERY = 0.1
REST_WITHIN, REST_AGAIN = 1.0, 0.01
"""s for which the last neutral of all is tried, and between two tries"""
FAULT, SLOWNESS, ARMING = "chip", "bus", "arming"


def keeps_settings(driver: PulseDriver) -> bool:
    """Say whether a chip still is as it was brought up, and not as one that has just got its supply."""
    try:
        look_twice(driver)
    except DeviceError:
        return False
    return True


def look_twice(driver: PulseDriver) -> None:
    """Raise DeviceError when the chip forgot its settings; one disturbance on the wires is no fault."""
    try:
        driver.check()
    except DeviceError:
        driver.check()


class Output:
    """Writes pulses; keeps the drive at rest while its chip is at fault, and while the ESC arms."""

    def __init__(self, driver: PulseDriver, drive: Drive, tell: Callable[[str], object]) -> None:
        self._driver = driver
        self._admission = drive.admission
        self._tell = tell
        self._calibration = drive.calibration
        self._neutral_us = drive.calibration.neutral_us
        self._taken: Mapping[int, float] = self._neutral_us
        self._written = 0.0
        self._failed = 0
        """Writes in a row."""
        self._slowness = Slowness()
        self._broken = False
        self._reads_rest = False
        self.is_cut = False
        """The watchdog says that no pulse leaves the chip, whatever it was told."""
        self._repair_at = 0.0
        self._armed_at = 0.0

    @property
    def is_well(self) -> bool:
        """The last pulses have arrived."""
        return not self._failed and not self._broken

    @property
    def evidence(self) -> Evidence:
        """What is known of the chip."""
        known: Confirmed = "read" if self._reads_rest else "cut" if self.is_cut else ""
        return Evidence(self._taken, self._written, known if self._admission.latch.stops else "")

    def start(self, now: float, arm: bool = True) -> None:
        """Bring the chip up at neutral; raises DeviceError when it does not come."""
        self._start()
        self._tell_others()
        if arm:
            self._arm(now)

    def write(self, pulse_us: Mapping[int, float], now: float) -> None:
        """Write the pulses of a step, unless the chip is being repaired."""
        if self._broken:
            return
        began = clock.now()
        try:
            self._take(pulse_us)
        except DeviceError as error:
            self._failed += 1
            if self._failed >= FAILED_STEPS:
                self._break(str(error), now)
        else:
            self._failed = 0
            self._notice_slowness(self._written - began, now)

    def check(self, now: float) -> None:
        """Read back what the chip must not forget; after a dip of its supply, writes still succeed.

        Not on a slow bus, where whatever is read holds up the next neutral.
        """
        if not self._broken and not self._slowness.is_slow:
            try:
                look_twice(self._driver)
            except DeviceError as error:
                self._break(str(error), now)
        self.confirm()

    def confirm(self) -> None:
        """Read back whether a robot that is stopped stands; what cannot be read is not known."""
        self._reads_rest = False
        if self._admission.latch.stops and not self._broken and not self._slowness.is_slow:
            with suppress(DeviceError):
                self._reads_rest = self._calibration.at_rest(self._driver.read(self._neutral_us))

    def tend(self, now: float) -> None:
        """Write neutral to a chip at fault, repair it, and end the arming pause, when it is time."""
        if self._broken and self._write_neutral() and now >= self._repair_at:
            self._repair(now)
        if not self._broken and now >= self._armed_at:
            self._admission.free(ARMING, now)

    def rest(self) -> None:
        """Leave neutral behind; raises DeviceError when the chip does not take it, however often it is asked.

        Nobody writes after this: a chip that fails just now goes on with the pulses it had.
        """
        give_up, tries = clock.now() + REST_WITHIN, round(REST_WITHIN / REST_AGAIN)
        while True:
            try:
                self._take(self._neutral_us)
            except DeviceError:
                tries -= 1
                if clock.now() >= give_up or not tries:
                    raise
                time.sleep(REST_AGAIN)
            else:
                return

    def close(self) -> None:
        self._driver.close()

    def _take(self, pulse_us: Mapping[int, float]) -> None:
        self._driver.write(pulse_us)
        self._taken = pulse_us
        self._written = clock.now()
        self._reads_rest = self._reads_rest and pulse_us == self._neutral_us

    def _start(self) -> None:
        self._driver.start(self._neutral_us)
        self._taken = self._neutral_us
        self._written = clock.now()

    def _tell_others(self) -> None:
        """Say which channels move that nobody here commands: no stop reaches them."""
        with suppress(DeviceError):
            found = self._driver.read([channel for channel in CHANNELS if channel not in self._neutral_us])
            if moving := [str(channel) for channel, width in found.items() if width is not None]:
                those = f"channel{'s'[: len(moving) - 1]} {', '.join(moving)}"
                self._tell(
                    f"there are pulses on {those} of the chip, which are not this robot's and which nothing "
                    "here stops: end what drives them, or switch the chip's supply off and on"
                )

    def _notice_slowness(self, took: float, now: float) -> None:
        """Keep the robot at rest on a bus that is slow: each command, and each neutral, would come late."""
        self._slowness.count(took)
        if self._slowness.lasts:
            words = f"its bus is slow: a write took {took * 1000:.0f} ms, of at most {SLOW * 1000:.0f}"
            if SLOWNESS not in self._admission.holds:
                self._tell(f"the chip is at fault: {words}")
            self._admission.hold(SLOWNESS, "fault", f"{words}; look at its wires, pull-ups and clock", now)
        elif self._slowness.is_over and SLOWNESS in self._admission.holds:
            self._tell("the bus of the chip is quick again")
            self._admission.free(SLOWNESS, now)

    def _write_neutral(self) -> bool:
        """Write neutral before anything else is thought about; return whether the bus has time for more.

        Bringing a chip up takes a dozen transfers. Where some of them fail, this one may not.
        """
        began = clock.now()
        with suppress(DeviceError):
            self._take(self._neutral_us)
        return clock.now() - began <= SLOW

    def _break(self, words: str, now: float) -> None:
        self._broken = True
        self._reads_rest = False
        self._repair_at = now
        self._tell(f"the chip is at fault: {words}")
        self._admission.hold(FAULT, "fault", words, now)

    def _repair(self, now: float) -> None:
        self._repair_at = now + REPAIR_EVERY
        try:
            self._start()
        except DeviceError as error:
            self._admission.hold(FAULT, "fault", str(error), now)
            return
        self._broken = False
        self._failed = 0
        self._tell("the chip is back, at neutral")
        self._arm(now)
        self._admission.free(FAULT, now)

    def _arm(self, now: float) -> None:
        self._armed_at = now + self._driver.arming
        self._admission.hold(
            ARMING, "starting", f"neutral for {self._driver.arming:g} s while the ESC arms", now
        )
