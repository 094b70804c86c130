import pytest

from zteleop.errors import DeviceError
from zteleop.inputs.evdev import pads as evdev_pads
from zteleop.inputs.evdev.codes import AXES, BUTTONS, EV_ABS, EV_KEY
from zteleop.inputs.evdev.device import RESYNC, Event, Range
from zteleop.inputs.evdev.devices import Change
from zteleop.inputs.evdev.pads import EvdevPads, is_pad
from zteleop.inputs.gamepad_map import FORGET, Moved

TL, X, Y = BUTTONS["BTN_TL"], AXES["ABS_X"], AXES["ABS_Y"]
AT_REST = [FORGET, Moved("BTN_TL", 0.0), Moved("ABS_X", 0.0), Moved("ABS_Y", 0.0)]


class Device:
    def __init__(self, name: str = "Pad") -> None:
        self.name, self.path = name, f"/dev/input/{name}"
        self.keys, self.axes = frozenset({TL}), frozenset({X, Y})
        self.pressed: set[int] = set()
        self.at = {X: 0, Y: 0}
        self.gone = False

    def down(self) -> set[int]:
        if self.gone:
            raise OSError
        return self.pressed

    def range(self, axis: int) -> Range:
        if self.gone:
            raise OSError
        return Range(self.at[axis], -100, 100)


class Devices:
    def __init__(self) -> None:
        self.open: list[Device] = []
        self.refused: dict[str, str] = {}
        self.changes: list[Change] = []
        self.closed = False

    def read(self, now: float) -> list[Change]:
        changes, self.changes = self.changes, []
        return changes

    def fileno(self) -> int:
        return 9

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def devices(monkeypatch: pytest.MonkeyPatch) -> Devices:
    devices = Devices()
    monkeypatch.setattr(evdev_pads, "Devices", lambda fits: devices)
    return devices


@pytest.fixture
def pad(devices: Devices) -> Device:
    devices.open = [Device()]
    return devices.open[0]


@pytest.fixture
def pads(devices: Devices, pad: Device) -> EvdevPads:
    pads = EvdevPads()
    pads.__enter__()
    assert pads.read(0.0) == AT_REST
    return pads


def test_the_first_pad_is_used_and_where_it_is_found_is_told(devices: Devices, pad: Device) -> None:
    devices.open.append(Device("Other"))
    pad.pressed, pad.at[Y] = {TL}, -50
    with EvdevPads() as pads:
        assert pads.name == "Pad"
        assert pads.names == ["Pad (/dev/input/Pad)", "Other (/dev/input/Other)"]
        assert pads.fileno() == 9
        found = [FORGET, Moved("BTN_TL", 1.0), Moved("ABS_X", 0.0), Moved("ABS_Y", -0.5)]
        assert pads.read(0.0) == found
        assert pads.read(0.1) == []
    assert devices.closed
    assert pads.name == ""


def test_what_moves_is_told_by_name(devices: Devices, pads: EvdevPads, pad: Device) -> None:
    events = [Event(EV_KEY, TL, 1), Event(EV_ABS, Y, -100), Event(EV_ABS, 0x3F, 1), Event(EV_KEY, 700, 1)]
    devices.changes = [Change(pad, "moved", [*events, Event(EV_ABS, AXES["ABS_RX"], 1)])]
    assert pads.read(0.1) == [Moved("BTN_TL", 1.0), Moved("ABS_Y", -1.0), Moved("ABS_RX", 0.0)]


def test_what_was_lost_is_asked_for(devices: Devices, pads: EvdevPads, pad: Device) -> None:
    pad.pressed = {TL}
    devices.changes = [Change(pad, "moved", [RESYNC])]
    assert pads.read(0.1) == [Moved("BTN_TL", 1.0), *AT_REST[2:]]


def test_what_was_lost_of_a_pad_just_unplugged_is_unknown(
    devices: Devices, pads: EvdevPads, pad: Device
) -> None:
    pad.gone = True
    devices.changes = [Change(pad, "moved", [RESYNC])]
    assert pads.read(0.1) == [FORGET]


def test_another_pad_counts_for_nothing_until_the_first_is_unplugged(
    devices: Devices, pads: EvdevPads, pad: Device
) -> None:
    other = Device("Other")
    devices.open.append(other)
    devices.changes = [Change(other, "plugged"), Change(other, "moved", [Event(EV_KEY, TL, 1)])]
    assert pads.read(0.1) == []
    devices.open.remove(pad)
    devices.changes = [Change(pad, "unplugged")]
    assert pads.read(0.2) == [FORGET, *AT_REST]
    assert pads.name == "Other"


def test_a_pad_gone_before_it_was_asked_is_none(devices: Devices, pad: Device) -> None:
    pad.gone = True
    with EvdevPads() as pads:
        assert pads.read(0.0) == []
        assert pads.name == ""


def test_without_a_pad_it_waits(devices: Devices) -> None:
    with EvdevPads() as pads:
        assert (pads.read(0.0), pads.name, pads.trouble, pads.names) == ([], "", "", [])
        devices.refused = {"/dev/input/event1": "Pad"}
        assert "found Pad (/dev/input/event1)" in pads.trouble


def test_a_pad_that_may_not_be_read_is_an_error_at_the_start(devices: Devices) -> None:
    devices.refused = {"/dev/input/event1": "Pad"}
    with pytest.raises(DeviceError, match="found Pad"):
        EvdevPads().__enter__()
    assert devices.closed


def test_a_pad_is_chosen_by_part_of_its_name() -> None:
    pads = EvdevPads("xbox")
    stick, buttons = frozenset({X, Y}), frozenset({TL})
    assert pads._fits(buttons, stick, "Microsoft Xbox pad")
    assert not pads._fits(buttons, stick, "Wireless Controller")
    assert not pads._fits(frozenset(), stick, "Xbox motion sensors")


@pytest.mark.parametrize(
    ("keys", "axes", "expected"),
    [
        ({BUTTONS["BTN_SOUTH"]}, {X, Y}, True),
        ({BUTTONS["BTN_TRIGGER"]}, {X, Y}, True),
        ({BUTTONS["BTN_SOUTH"], 0x14B}, {X, Y}, False),  # a tablet
        ({0x110}, {X, Y}, False),  # a mouse
        ({0x14A}, {X, Y}, False),  # a touch pad
        (set(), {X, Y}, False),  # motion sensors
        ({BUTTONS["BTN_SOUTH"]}, {X}, False),
    ],
)
def test_a_pad_is_a_stick_with_buttons(keys: set[int], axes: set[int], expected: bool) -> None:
    assert is_pad(frozenset(keys), frozenset(axes)) is expected
