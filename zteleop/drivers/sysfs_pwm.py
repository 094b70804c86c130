"""Linux's own PWM outputs, /sys/class/pwm: two pins of a Raspberry Pi, and many another board's.

Kernel: Documentation/driver-api/pwm.rst, "Using PWMs with the sysfs interface"; widths are whole ns there.
"""

import errno
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Annotated, Protocol

from msgspec import Meta, Struct

from zteleop.drivers.lock import Lock, machine_folder
from zteleop.drivers.port import again
from zteleop.drivers.registers import CHANNELS, TICKS, longest_us
from zteleop.errors import ConfigError, DeviceError

DUTY, PERIOD, ENABLE, POLARITY = "duty_cycle", "period", "enable", "polarity"
NORMAL = "normal"
WRITABLE_WITHIN, LOOK_EVERY = 1.0, 0.01
"""s in which udev gives a channel that was just exported to its group, and between two looks"""
OVERLAY = "dtoverlay=pwm-2chan in /boot/firmware/config.txt gives a Raspberry Pi one"


class SysfsPwmSettings(Struct, frozen=True, forbid_unknown_fields=True):
    chip: Annotated[int, Meta(ge=0)] = 0
    """The 0 of /sys/class/pwm/pwmchip0; often another on a Raspberry Pi 5."""
    frequency_hz: Annotated[float, Meta(ge=24, le=400)] = 60.0
    arming: Annotated[float, Meta(ge=0, le=10)] = 2.0
    """s at neutral before the first command; most ESCs learn neutral in them."""
    folder: str = "/sys/class/pwm"
    """Where the kernel shows its PWM chips."""


SETTINGS = SysfsPwmSettings


class Files(Protocol):
    """The kernel's files; each holds one word, and says OSError where it does not obey."""

    def read(self, path: str) -> str: ...
    def write(self, path: str, text: str) -> None: ...
    def exists(self, path: str) -> bool: ...
    def writable(self, path: str) -> bool: ...


class KernelFiles:
    """The files there are."""

    def read(self, path: str) -> str:
        with open(path, encoding="ascii") as file:
            return file.read().strip()

    def write(self, path: str, text: str) -> None:
        """Write a word in one piece: the kernel takes each write by itself."""
        file = os.open(path, os.O_WRONLY)
        try:
            os.write(file, text.encode())
        finally:
            os.close(file)

    def exists(self, path: str) -> bool:
        return os.path.exists(path)

    def writable(self, path: str) -> bool:
        return os.access(path, os.W_OK)


def count_us(settings: SysfsPwmSettings) -> float:
    """Return the length of one of the 4096 counts that a period is said to have here, in us."""
    return 1e6 / settings.frequency_hz / TICKS


class SysfsPwm:
    """Sets pulse widths; the kernel repeats them, also after this process, until somebody disables them.

    Each channel is a file of its own: two that are written together change one after the other.
    """

    def __init__(
        self,
        settings: SysfsPwmSettings,
        files: Files | None = None,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._files = files or KernelFiles()
        self._sleep = sleep
        self._lock: Lock | None = None
        self._chip = f"{settings.folder}/pwmchip{settings.chip}"
        self._period_ns = str(round(1e9 / settings.frequency_hz))
        self.tick_us = count_us(settings)
        self.arming = settings.arming
        self._started: set[int] = set()

    def claim(self, path: str) -> None:
        """Keep other drivers off the chip by a lock file; raises DeviceError naming who has it."""
        self._lock = Lock(path, f"the PWM chip {self._chip}")

    def shared(self) -> list[int]:
        """Return the descriptors that a process must inherit to keep other drivers off as well."""
        file = self._lock.fileno() if self._lock else None
        return [] if file is None else [file]

    def start(self, neutral_us: Mapping[int, float]) -> None:
        """Bring these channels up at neutral, and read everything back.

        Raises DeviceError in words, ConfigError for a pulse that does not fit the period.
        """
        widths = self._widths(neutral_us)
        with self._in_words():
            for channel, width in widths.items():
                self._export(channel)
                self._bring_up(channel, width)
            self._started |= widths.keys()
            self._verify({(channel, DUTY): width for channel, width in widths.items()})

    def write(self, pulse_us: Mapping[int, float]) -> None:
        """Write every channel given, whatever they were before.

        Raises DeviceError after three failures in a row, ConfigError for a pulse longer than the period.
        """
        widths = self._widths(pulse_us)
        failed: list[OSError] = []
        with self._in_words():
            for channel, width in widths.items():
                try:
                    self._set(channel, DUTY, width)
                except OSError as error:  # the others must not stay where they were for this one's sake
                    failed.append(error)
            if failed:
                raise failed[0]

    def read(self, channels: Iterable[int]) -> dict[int, float | None]:
        """Return the pulse widths in us that leave the chip now; None where there are none."""
        with self._in_words():
            return {channel: self._width(channel) for channel in channels}

    def check(self) -> None:
        """Raise DeviceError when a channel is not as it was started, as after its module was loaded anew."""
        with self._in_words():
            self._verify({})

    def close(self) -> None:
        """Release the lock; the outputs stay as last written."""
        if self._lock:
            self._lock.release()

    def _width(self, channel: int) -> float | None:
        if not self._files.exists(self._path(channel, ENABLE)) or self._get(channel, ENABLE) != "1":
            return None
        return int(self._get(channel, DUTY)) / 1000 or None

    def _export(self, channel: int) -> None:
        """Ask the kernel for a channel, and wait until udev has given it to whoever may use it."""
        if not self._files.exists(self._path(channel, DUTY)):
            again(lambda: self._files.write(f"{self._chip}/export", str(channel)))
        for _ in range(round(WRITABLE_WITHIN / LOOK_EVERY)):
            if self._files.writable(self._path(channel, DUTY)):
                return
            self._sleep(LOOK_EVERY)

    def _bring_up(self, channel: int, width: str) -> None:
        """Write a width: without a gap where the channel runs already, else after its period."""
        if not self._runs(channel):
            if self._get(channel, ENABLE) == "1":
                self._set(channel, ENABLE, "0")
            if int(self._get(channel, DUTY)) > int(self._period_ns):  # which the kernel would refuse
                self._set(channel, DUTY, "0")
            self._set(channel, PERIOD, self._period_ns)
            if self._polarity(channel) != NORMAL:
                self._set(channel, POLARITY, NORMAL)
        self._set(channel, DUTY, width)
        if self._get(channel, ENABLE) != "1":
            self._set(channel, ENABLE, "1")

    def _runs(self, channel: int) -> bool:
        wanted = {ENABLE: "1", PERIOD: self._period_ns}
        same = all(self._get(channel, name) == value for name, value in wanted.items())
        return same and self._polarity(channel) == NORMAL

    def _polarity(self, channel: int) -> str:
        """Return it; a chip that has but one shows no such file."""
        there = self._files.exists(self._path(channel, POLARITY))
        return self._get(channel, POLARITY) if there else NORMAL

    def _verify(self, more: Mapping[tuple[int, str], str]) -> None:
        """Raise DeviceError naming the files that do not hold what was written."""
        wanted = {
            (channel, name): value
            for channel in self._started
            for name, value in ((ENABLE, "1"), (PERIOD, self._period_ns))
        }
        wanted |= more
        found = {place: self._get(*place) for place in wanted}
        wrong = [
            f"{name} of channel {channel} reads {found[channel, name]}, not {value}"
            for (channel, name), value in wanted.items()
            if found[channel, name] != value
        ]
        if wrong:
            raise DeviceError(
                f"{self._chip} does not hold what was written ({', '.join(wrong)}); "
                "check that nothing else writes to it"
            )

    def _widths(self, pulse_us: Mapping[int, float]) -> dict[int, str]:
        """Return what is written for each width: whole ns."""
        for channel, width in pulse_us.items():
            if channel not in CHANNELS or not 0 < width < longest_us(self.tick_us):
                raise ConfigError(
                    f"channel {channel}, {width:g} us: expected a channel of 0..15 and a pulse within the "
                    f"period of {TICKS * self.tick_us:.0f} us; lower frequency_hz for a longer one"
                )
        return {channel: str(round(width * 1000)) for channel, width in pulse_us.items()}

    def _get(self, channel: int, name: str) -> str:
        return again(lambda: self._files.read(self._path(channel, name)))

    def _set(self, channel: int, name: str, value: str) -> None:
        again(lambda: self._files.write(self._path(channel, name), value))

    def _path(self, channel: int, name: str) -> str:
        return f"{self._chip}/pwm{channel}/{name}"

    @contextmanager
    def _in_words(self) -> Iterator[None]:
        """Turn OSError, and a file that holds no number, into DeviceError."""
        try:
            yield
        except DeviceError:
            raise
        except ValueError as error:
            raise DeviceError(f"{self._chip}: expected a number of ns, found {error}") from error
        except OSError as error:
            raise DeviceError(f"{self._chip}: {self._why(error)}") from error

    def _why(self, error: OSError) -> str:
        if not self._files.exists(f"{self._chip}/export"):
            return f"there is no such PWM chip; set chip to one of those there, {OVERLAY}"
        sentences = {
            errno.EACCES: "this user may not write there; sudo usermod -aG gpio $USER, and log in again",
            errno.EBUSY: "a channel is used by something else in the kernel; free it, or choose another",
            errno.ENODEV: f"it has no such channel; {self._chip}/npwm says how many there are",
            errno.EINVAL: "it cannot make such a pulse; set another frequency_hz",
        }
        return sentences.get(error.errno or 0, error.strerror or str(error))


def open_driver(settings: SysfsPwmSettings, *, exclusive: bool = True) -> SysfsPwm:
    """Open a PWM chip of the kernel; raises DeviceError when another process drives it."""
    driver = SysfsPwm(settings)
    if exclusive:
        folder = settings.folder.strip("/").replace("/", "-")
        driver.claim(f"{machine_folder()}/zteleop-{folder}-pwmchip{settings.chip}.lock")
    return driver
