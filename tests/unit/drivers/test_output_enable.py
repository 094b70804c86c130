import errno
import os
import re
import sys
from dataclasses import dataclass
from enum import Enum
from types import SimpleNamespace, TracebackType
from typing import Self

import pytest

from zteleop.drivers import output_enable
from zteleop.drivers.output_enable import OutputEnable, open_output_enable
from zteleop.errors import ConfigError, DeviceError

CHIP = "/dev/gpiochip0"


class Direction(Enum):
    AS_IS, INPUT, OUTPUT = 1, 2, 3


class Value(Enum):
    INACTIVE, ACTIVE = 0, 1


@dataclass
class Settings:
    direction: Direction = Direction.AS_IS
    active_low: bool = False
    output_value: Value = Value.INACTIVE


class Pin:
    """A line as a voltmeter sees it, in the hands of a request."""

    def __init__(self, settings: Settings) -> None:
        self.is_low, self.released, self.error = False, False, 0
        self._active_low = settings.active_low
        self.set_value(17, settings.output_value)

    def set_value(self, line: int | str, value: Value) -> None:
        assert line == 17
        assert not self.released
        if self.error:
            raise OSError(self.error, os.strerror(self.error))
        self.is_low = (value is Value.ACTIVE) == self._active_low

    def release(self) -> None:
        self.released = True


class Chip:
    def __init__(self, path: str, consumer: str = "") -> None:
        self._consumer = consumer

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None: ...

    def get_line_info(self, line: int | str) -> SimpleNamespace:
        return SimpleNamespace(offset=line, used=True, consumer=self._consumer)


class FakeGpiod:
    """Stands for the module, version 2, with one line 17."""

    line = SimpleNamespace(Direction=Direction, Value=Value)
    LineSettings = Settings

    def __init__(self, error: Exception | int | None = None, consumer: str = "") -> None:
        self.error = OSError(error, os.strerror(error)) if isinstance(error, int) else error
        self.consumer = consumer
        self.requests: list[tuple[str, str | None, Settings]] = []

    def Chip(self, path: str) -> Chip:  # noqa: N802
        return Chip(path, self.consumer)

    def request_lines(
        self, path: str, config: dict[int | str, Settings | None], consumer: str | None = None
    ) -> Pin:
        if self.error:
            raise self.error
        settings = config[17]
        assert settings
        self.requests.append((path, consumer, settings))
        self.pin = Pin(settings)
        return self.pin


@pytest.fixture
def gpiod() -> FakeGpiod:
    return FakeGpiod()


@pytest.fixture
def pin(gpiod: FakeGpiod) -> OutputEnable:
    return open_output_enable(CHIP, 17, gpiod)


def test_the_line_is_taken_as_an_output_that_is_high(gpiod: FakeGpiod, pin: OutputEnable) -> None:
    [(path, consumer, settings)] = gpiod.requests
    assert (path, consumer, settings.direction) == (CHIP, "zteleop", Direction.OUTPUT)
    assert not gpiod.pin.is_low


def test_low_lets_the_pulses_out_and_high_keeps_them_in(gpiod: FakeGpiod, pin: OutputEnable) -> None:
    pin.enable()
    assert gpiod.pin.is_low
    pin.disable()
    assert not gpiod.pin.is_low


def test_closing_keeps_the_pulses_in_and_gives_the_line_back(gpiod: FakeGpiod, pin: OutputEnable) -> None:
    pin.enable()
    pin.close()
    assert (gpiod.pin.is_low, gpiod.pin.released) == (False, True)
    pin.close()
    with pytest.raises(DeviceError, match=r"^OE on line 17 of /dev/gpiochip0 is closed; open it again"):
        pin.enable()


def test_a_line_that_no_longer_obeys_says_so_and_is_given_back(gpiod: FakeGpiod, pin: OutputEnable) -> None:
    gpiod.pin.error = errno.ENODEV
    for act in (pin.enable, pin.disable, pin.close):
        with pytest.raises(DeviceError, match=r"^/dev/gpiochip0 is no GPIO chip, or no longer"):
            act()
    assert gpiod.pin.released


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (errno.ENOENT, "/dev/gpiochip0 not found; gpiodetect lists the chips, set oe_chip to one of them"),
        (
            errno.ENODEV,
            "/dev/gpiochip0 is no GPIO chip, or no longer; gpiodetect lists them, set oe_chip to one of them",
        ),
        (
            errno.EACCES,
            "/dev/gpiochip0: no permission; add yourself to group gpio (sudo usermod -aG gpio $USER) "
            "and log in again",
        ),
        (
            errno.EBUSY,
            "OE on line 17 of /dev/gpiochip0 is taken by somebody without a name (gpioinfo); "
            "end it, or set oe_line to another",
        ),
        (
            errno.EIO,
            "OE on line 17 of /dev/gpiochip0: Input/output error; check oe_chip and oe_line with gpioinfo",
        ),
        (
            ValueError("line offset of out range"),
            "OE on line 17 of /dev/gpiochip0: there is no such line; set oe_line to a BCM number",
        ),
    ],
)
def test_a_line_that_cannot_be_had_says_why_and_what_to_do(error: Exception | int, sentence: str) -> None:
    with pytest.raises(DeviceError, match=f"^{re.escape(sentence)}$"):
        open_output_enable(CHIP, 17, FakeGpiod(error))


def test_a_line_that_is_taken_says_by_whom() -> None:
    with pytest.raises(DeviceError, match=r"is taken by another-robot \(gpioinfo\)"):
        open_output_enable(CHIP, 17, FakeGpiod(errno.EBUSY, "another-robot"))


def test_without_gpiod_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gpiod", None)
    monkeypatch.setattr(sys, "platform", "linux")
    with pytest.raises(DeviceError, match=r"needs Linux and gpiod \(.*pip install .*\[gpio\]'\)"):
        open_output_enable(CHIP, 17)


def test_the_first_gpiod_with_another_api_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gpiod", SimpleNamespace(__version__="1.6.3"))
    with pytest.raises(DeviceError, match=r"needs gpiod 2.1 or later, found 1.6.3"):
        open_output_enable(CHIP, 17)


def test_only_a_driver_with_the_pin_configured_has_one(
    gpiod: FakeGpiod, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "gpiod", gpiod)
    assert output_enable("simulated", {}) is None
    assert output_enable("pca9685", {}) is None
    assert gpiod.requests == []
    pin = output_enable("pca9685", {"oe_line": 17, "oe_chip": "/dev/gpiochip4"})
    assert pin
    pin.enable()
    assert gpiod.requests[0][0] == "/dev/gpiochip4"
    assert gpiod.pin.is_low


@pytest.mark.parametrize("line", [-1, "17", 17.5])
def test_a_line_that_is_no_number_is_refused(line: object) -> None:
    with pytest.raises(ConfigError, match=r"drivers\.pca9685\.oe_line"):
        output_enable("pca9685", {"oe_line": line})
