import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from zteleop.errors import DeviceError
from zteleop.inputs.evdev import devices as evdev_devices
from zteleop.inputs.evdev.device import Event
from zteleop.inputs.evdev.devices import LOOK_EVERY, Change, Devices, capabilities, may_not_read

PRESS = Event(1, 17, 1)


class Device:
    """An event device that opens on any file, and says what the file says."""

    forbidden: set[str] = set()
    opened: list["Device"] = []

    def __init__(self, path: str) -> None:
        self.path = path
        name = os.path.basename(path)
        if name in self.forbidden:
            raise PermissionError(errno.EACCES, "Permission denied")
        self.opened.append(self)
        self.name = Path(path).read_text()
        self.keys, self.axes = frozenset({17}), frozenset()
        self.happened: list[Event] = []
        self.gone = self.closed = False
        self._pipe = os.pipe()

    def fileno(self) -> int:
        return self._pipe[0]

    def read(self) -> list[Event]:
        if self.gone:
            raise OSError(errno.ENODEV, "No such device")
        happened, self.happened = self.happened, []
        return happened

    def close(self) -> None:
        if not self.closed:
            self.closed = True
            for fd in self._pipe:
                os.close(fd)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "input"
    folder.mkdir()
    monkeypatch.setattr(evdev_devices, "FOLDER", str(folder))
    monkeypatch.setattr(evdev_devices, "SYSFS", str(tmp_path / "sys"))
    monkeypatch.setattr(evdev_devices, "EventDevice", Device)
    monkeypatch.setattr(Device, "forbidden", set())
    monkeypatch.setattr(Device, "opened", [])
    return folder


@pytest.fixture
def devices() -> Iterator[Devices]:
    devices = Devices(lambda keys, axes, name: 17 in keys and name != "mouse")
    yield devices
    devices.close()


def plug(folder: Path, node: str, name: str = "keyboard") -> None:
    (folder / node).write_text(name)


def test_whatever_fits_is_found_in_the_order_of_its_number(folder: Path, devices: Devices) -> None:
    for node in ("event10", "event2", "js0", "mice"):
        plug(folder, node)
    plug(folder, "event3", "mouse")
    changes = devices.read(0.0)
    assert [change.device.path for change in changes] == [f"{folder}/event2", f"{folder}/event10"]
    assert {change.what for change in changes} == {"plugged"}
    assert [device.path for device in devices.open] == [f"{folder}/event2", f"{folder}/event10"]


def test_what_is_plugged_in_later_is_found_within_a_second(folder: Path, devices: Devices) -> None:
    assert devices.read(0.0) == []
    plug(folder, "event0")
    assert devices.read(LOOK_EVERY / 2) == []
    assert [change.what for change in devices.read(LOOK_EVERY)] == ["plugged"]
    assert devices.read(3 * LOOK_EVERY) == []


def test_what_does_not_fit_is_opened_once(folder: Path, devices: Devices) -> None:
    plug(folder, "event0", "mouse")
    for now in range(5):
        devices.read(float(now))
    (mouse,) = Device.opened
    assert mouse.closed


def test_events_are_told_with_their_device(folder: Path, devices: Devices) -> None:
    plug(folder, "event0")
    (change,) = devices.read(0.0)
    change.device.happened = [PRESS]
    assert devices.read(0.1) == [Change(change.device, "moved", [PRESS])]
    assert devices.read(0.2) == []


def test_what_is_unplugged_is_told_once_and_found_again(folder: Path, devices: Devices) -> None:
    plug(folder, "event0")
    (change,) = devices.read(0.0)
    (folder / "event0").unlink()
    change.device.gone = True
    assert devices.read(0.1) == [Change(change.device, "unplugged")]
    assert change.device.closed
    assert devices.open == ()
    assert devices.read(2.0) == []
    plug(folder, "event0")
    assert [found.what for found in devices.read(4.0)] == ["plugged"]


def test_what_may_not_be_read_is_known_by_what_sysfs_says(folder: Path, devices: Devices) -> None:
    Device.forbidden |= {"event0", "event1", "event2"}
    for number, name in enumerate(("keyboard", "mouse")):
        plug(folder, f"event{number}")
        about = folder.parent / "sys" / f"event{number}" / "device"
        (about / "capabilities").mkdir(parents=True)
        (about / "name").write_text(f"{name}\n")
        (about / "capabilities" / "key").write_text("20000\n")
        (about / "capabilities" / "abs").write_text("0\n")
    plug(folder, "event2")
    assert devices.read(0.0) == []
    assert devices.refused == {f"{folder}/event0": "keyboard"}
    Device.forbidden.clear()
    (folder / "event0").chmod(0o640)  # as udev does a moment later
    assert [change.device.path for change in devices.read(2.0)] == [f"{folder}/event0"]
    assert devices.refused == {}


def test_a_refusal_ends_with_its_device(folder: Path, devices: Devices) -> None:
    devices.refused = {f"{folder}/event7": "keyboard"}
    devices.read(0.0)
    assert devices.refused == {}


def test_without_a_folder_there_is_nothing(folder: Path, devices: Devices) -> None:
    folder.rmdir()
    assert devices.read(0.0) == []


def test_it_wakes_for_each_of_them(folder: Path, devices: Devices) -> None:
    plug(folder, "event0")
    (change,) = devices.read(0.0)
    assert devices.fileno() >= 0
    os.write(change.device._pipe[1], b"x")
    assert devices._epoll.poll(0)


def test_another_system_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(DeviceError, match="found darwin, which has none"):
        Devices(lambda keys, axes, name: True)


@pytest.mark.parametrize(("text", "expected"), [("20000\n", {17}), ("1 3\n", {0, 1, 64}), ("0\n", set())])
def test_sysfs_says_words_of_bits(tmp_path: Path, text: str, expected: set[int]) -> None:
    (tmp_path / "key").write_text(text)
    assert capabilities(tmp_path / "key") == expected


def test_a_sentence_says_what_was_found_what_to_do_and_what_that_means() -> None:
    words = may_not_read({"/dev/input/event3": "AT keyboard"}, "a keyboard")
    assert "found AT keyboard (/dev/input/event3)" in words
    assert "sudo usermod -aG input $USER" in words
    assert "every key typed" in words
