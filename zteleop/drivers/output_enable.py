"""The chip's OE pin on a GPIO line: low lets pulses out, high stops them, whatever the chip was told."""

import errno
import sys
from typing import Any

from zteleop.errors import DeviceError, install

CONSUMER = "zteleop"


class OutputEnable:
    """Holds the line for as long as its process lives, which is what makes the pin a protection.

    When the process dies the kernel frees the line and makes it an input, so that a pull-up on OE stops the
    pulses; but not where /sys/module/pinctrl_*/parameters/persist_gpio_outputs says Y, as Raspberry Pi OS
    may by default: there the pin keeps its level, and a dead process leaves the outputs enabled.
    """

    def __init__(self, request: Any, line: int, value: Any, name: str) -> None:
        self._request = request
        self._line = line
        self._value = value
        self._name = name

    def enable(self) -> None:
        """Let the pulses out: the pin goes low; raises DeviceError."""
        self._set(self._value.ACTIVE)

    def disable(self) -> None:
        """Keep the pulses in: the pin goes high; raises DeviceError."""
        self._set(self._value.INACTIVE)

    def close(self) -> None:
        """Disable and give the line back, more than once if need be."""
        request, self._request = self._request, None
        if request is None:
            return
        try:
            request.set_value(self._line, self._value.INACTIVE)
        except OSError as error:
            raise _failure(error, self._name) from error
        finally:
            request.release()

    def _set(self, value: Any) -> None:
        if self._request is None:
            raise DeviceError(f"{self._name} is closed; open it again to switch it")
        try:
            self._request.set_value(self._line, value)
        except OSError as error:
            raise _failure(error, self._name) from error


def open_output_enable(chip: str, line: int, gpiod: Any = None) -> OutputEnable:
    """Take a GPIO line as the OE pin, disabled at first; tests bring their own gpiod.

    Raises DeviceError when gpiod or the chip is missing, or the line forbidden or taken.
    """
    gpiod = gpiod or _gpiod()
    name = f"OE on line {line} of {chip}"
    high = gpiod.LineSettings(
        direction=gpiod.line.Direction.OUTPUT, active_low=True, output_value=gpiod.line.Value.INACTIVE
    )
    try:
        request = gpiod.request_lines(chip, consumer=CONSUMER, config={line: high})
    except ValueError as error:  # gpiod's own, for a number beyond the chip's lines
        raise DeviceError(f"{name}: there is no such line; set oe_line to a BCM number") from error
    except OSError as error:
        owner = _owner(gpiod, chip, line) if error.errno == errno.EBUSY else ""
        raise _failure(error, name, owner) from error
    return OutputEnable(request, line, gpiod.line.Value, name)


def _gpiod() -> Any:
    how = install("gpio") if sys.platform == "linux" else f"this is {sys.platform}"
    try:
        import gpiod
    except ImportError as error:
        raise DeviceError(f"the OE pin needs Linux and gpiod ({how}); or leave oe_line unset") from error
    if not hasattr(gpiod, "request_lines"):  # Debian 12's own python3-libgpiod is version 1
        raise DeviceError(
            f"the OE pin needs gpiod 2.1 or later, found {getattr(gpiod, '__version__', 'an older one')}; "
            f"say: {how}"
        )
    return gpiod


def _owner(gpiod: Any, chip: str, line: int) -> str:
    try:
        with gpiod.Chip(chip) as opened:
            return str(opened.get_line_info(line).consumer)
    except OSError:
        return ""


def _failure(error: OSError, name: str, owner: str = "") -> DeviceError:
    chip = name.rpartition(" ")[2]
    sentences = {
        errno.ENOENT: f"{chip} not found; gpiodetect lists the chips, set oe_chip to one of them",
        errno.ENODEV: f"{chip} is no GPIO chip, or no longer; gpiodetect lists them, "
        "set oe_chip to one of them",
        errno.EACCES: f"{chip}: no permission; add yourself to group gpio (sudo usermod -aG gpio $USER) "
        "and log in again",
        errno.EBUSY: f"{name} is taken by {owner or 'somebody without a name'} (gpioinfo); "
        "end it, or set oe_line to another",
    }
    otherwise = f"{name}: {error.strerror or error}; check oe_chip and oe_line with gpioinfo"
    return DeviceError(sentences.get(error.errno or 0, otherwise))
