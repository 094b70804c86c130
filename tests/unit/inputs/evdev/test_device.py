import errno
import fcntl
import os
import sys
from collections.abc import Iterator

import pytest

from zteleop.inputs.evdev import device as evdev
from zteleop.inputs.evdev.codes import EV_ABS, EV_KEY, EV_SYN, SYN_DROPPED, SYN_REPORT
from zteleop.inputs.evdev.device import EVENT, RESYNC, Event, EventDevice, Range, bits

REPORT = (EV_SYN, SYN_REPORT, 0)
DROPPED = (EV_SYN, SYN_DROPPED, 0)
W, A = 17, 30


class Kernel:
    """What ioctls say, and what events are on their way."""

    def __init__(self) -> None:
        self.reader, self.writer = os.pipe()
        os.set_blocking(self.reader, False)
        self.flags = 0
        self.grabs: list[int] = []
        self.answers = {
            0x80084502: (3).to_bytes(2, sys.byteorder) + bytes(6),
            0x81004506: b" A keyboard \0",
            0x80604518: (1 << W).to_bytes(96, "little"),
            0x80604521: (1 << W | 1 << A).to_bytes(96, "little"),
            0x80084523: bytes([0b11]),
            0x80184541: b"".join(n.to_bytes(4, sys.byteorder, signed=True) for n in (-5, -10, 10, 0, 0, 0)),
        }

    def open(self, path: str, flags: int) -> int:
        assert path == "/dev/input/event3"
        self.flags = flags
        return self.reader

    def ioctl(self, fd: int, request: int, argument: object) -> int:
        assert fd == self.reader
        if isinstance(argument, int):
            assert request == 0x40044590
            self.grabs.append(argument)
            return 0
        answer = self.answers[request]
        argument[: len(answer)] = type(argument)("B", answer)
        return len(answer)

    def say(self, *events: tuple[int, int, int]) -> None:
        os.write(self.writer, b"".join(EVENT.pack(12, 34, *event) for event in events))


@pytest.fixture
def kernel(monkeypatch: pytest.MonkeyPatch) -> Iterator[Kernel]:
    kernel = Kernel()
    monkeypatch.setattr(evdev.os, "open", kernel.open)
    monkeypatch.setattr(fcntl, "ioctl", kernel.ioctl)
    yield kernel
    os.close(kernel.writer)


@pytest.fixture
def device(kernel: Kernel) -> Iterator[EventDevice]:
    device = EventDevice("/dev/input/event3")
    yield device
    device.close()


def test_a_device_says_what_it_is(kernel: Kernel, device: EventDevice) -> None:
    assert kernel.flags & os.O_NONBLOCK
    assert kernel.flags & os.O_CLOEXEC
    assert device.name == "A keyboard"
    assert device.bus == 3
    assert device.keys == {W, A}
    assert device.axes == {0, 1}
    assert device.down() == {W}
    assert device.range(1) == Range(-5, -10, 10)


def test_a_device_without_a_name_is_its_path(kernel: Kernel) -> None:
    kernel.answers[0x81004506] = b"\0"
    assert EventDevice("/dev/input/event3").name == "/dev/input/event3"


def test_nothing_that_happened_is_nothing(device: EventDevice) -> None:
    assert device.read() == []


def test_events_come_in_order_without_their_reports(kernel: Kernel, device: EventDevice) -> None:
    kernel.say((EV_KEY, W, 1), REPORT, (EV_ABS, 1, -3), REPORT, (EV_KEY, W, 0), REPORT)
    assert device.read() == [Event(EV_KEY, W, 1), Event(EV_ABS, 1, -3), Event(EV_KEY, W, 0)]
    assert device.read() == []


def test_more_events_than_one_read_takes(kernel: Kernel, device: EventDevice) -> None:
    for number in range(200):
        kernel.say((EV_ABS, 0, number), REPORT)
    assert [event.value for event in device.read()] == list(range(200))


def test_what_follows_a_loss_is_half_of_a_change(kernel: Kernel, device: EventDevice) -> None:
    kernel.say((EV_KEY, A, 1), REPORT, DROPPED, (EV_KEY, W, 0))
    assert device.read() == [Event(EV_KEY, A, 1)]
    kernel.say((EV_ABS, 0, 1), REPORT, (EV_KEY, A, 0), REPORT)
    assert device.read() == [RESYNC, Event(EV_KEY, A, 0)]


def test_a_device_that_was_unplugged_raises(device: EventDevice, monkeypatch: pytest.MonkeyPatch) -> None:
    def read(fd: int, size: int) -> bytes:
        raise OSError(errno.ENODEV, "No such device")

    monkeypatch.setattr(evdev.os, "read", read)
    with pytest.raises(OSError, match="No such device"):
        device.read()


def test_a_grab_is_taken_and_given_back(kernel: Kernel, device: EventDevice) -> None:
    device.grab(True)
    device.grab(False)
    assert kernel.grabs == [1, 0]


def test_what_cannot_be_asked_is_not_left_open(kernel: Kernel) -> None:
    del kernel.answers[0x80604521]
    with pytest.raises(KeyError):
        EventDevice("/dev/input/event3")
    with pytest.raises(OSError, match="Bad file"):
        os.fstat(kernel.reader)


def test_closing_twice_closes_nobody_elses_file(device: EventDevice) -> None:
    device.close()
    device.close()


@pytest.mark.parametrize(
    ("value", "fraction"), [(-10, -1.0), (0, 0.0), (5, 0.5), (10, 1.0), (99, 1.0), (-99, -1.0)]
)
def test_an_axis_lies_between_its_ends(value: int, fraction: float) -> None:
    assert Range(0, -10, 10).fraction(value) == fraction


def test_an_axis_without_a_length_is_at_rest() -> None:
    assert Range(0, 0, 0).fraction(7) == 0.0


def test_bits_are_numbered_from_the_first_byte_up() -> None:
    assert list(bits(bytes([0b101, 0, 0b10000000]))) == [0, 2, 23]
