"""Presses that a terminal tells, and releases that a keyboard tells."""

import os
from types import SimpleNamespace

import pytest

from zteleop.errors import DeviceError
from zteleop.inputs.evdev.codes import EV_KEY
from zteleop.inputs.evdev.device import RESYNC, Event
from zteleop.inputs.evdev.devices import Change
from zteleop.inputs.evdev.told_keys import EARLY, LATE, ToldKeys, is_keyboard
from zteleop.inputs.keyboard import Keyboard
from zteleop.terminal.typed import Typed
from zteleop.testing import FakeTerminal

W, A, S, Q, SHIFT = 17, 30, 31, 16, 42
BOARD = SimpleNamespace(path="/dev/input/event3")


class Devices:
    def __init__(self, *boards: object) -> None:
        self.changes = [Change(board, "plugged") for board in boards]
        self.refused: dict[str, str] = {}
        self.closed = False
        self._ear, self._mouth = os.pipe()

    def fileno(self) -> int:
        return self._ear

    def read(self, now: float) -> list[Change]:
        changes, self.changes = self.changes, []
        return changes

    def close(self) -> None:
        self.closed = True
        os.close(self._ear)
        os.close(self._mouth)


class Desk:
    """A terminal with a keyboard before it."""

    def __init__(self) -> None:
        self.terminal, self.devices, self.now = FakeTerminal(), Devices(BOARD), 100.0
        self.keys = ToldKeys(Typed(self.terminal), self.devices)

    def move(self, *moves: tuple[int, int]) -> None:
        events = [Event(EV_KEY, code, value) for code, value in moves]
        self.devices.changes.append(Change(BOARD, "moved", events))

    def type(self, text: str) -> None:
        self.terminal.typed += text.encode()

    def read(self, after: float = 0.02) -> list[tuple[str, str]]:
        self.now += after
        return [(key.name, key.event) for key in self.keys.read(self.now)]

    def press(self, code: int, text: str) -> list[tuple[str, str]]:
        self.move((code, 1))
        self.type(text)
        return self.read()


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_a_press_is_the_terminals_and_a_release_the_keyboards(desk: Desk) -> None:
    assert desk.keys.releases.told
    assert desk.press(W, "w") == [("w", "press")]
    desk.type("w")
    assert desk.read() == [("w", "repeat")]
    desk.move((W, 2))
    assert desk.read() == []
    desk.move((W, 0))
    assert desk.read() == [("w", "release")]


def test_what_is_typed_in_another_window_is_nothing(desk: Desk) -> None:
    desk.move((W, 1))
    assert desk.read() == []
    assert desk.read(LATE) == []
    desk.type("w")
    assert desk.read() == [] == desk.read(2 * EARLY)
    desk.move((W, 0))
    assert desk.read() == []


def test_what_comes_without_a_keyboard_is_nothing(desk: Desk) -> None:
    desk.type("wwwaaa")  # pasted, or typed at another machine
    assert desk.read() == [] == desk.read(2 * EARLY)
    assert desk.press(W, "w") == [("w", "press")], "and takes nothing away"


def test_either_may_come_first(desk: Desk) -> None:
    desk.type("w")
    assert desk.read() == []
    desk.move((W, 1))
    assert desk.read() == [("w", "press")]
    desk.move((A, 1))
    assert desk.read() == []
    desk.type("a")
    assert desk.read() == [("a", "press")]


def test_two_keys_are_held_and_each_is_let_go(desk: Desk) -> None:
    assert desk.press(W, "w") + desk.press(A, "a") == [("w", "press"), ("a", "press")]
    desk.type("a")
    assert desk.read() == [("a", "repeat")]
    desk.move((W, 0))
    assert desk.read() == [("w", "release")]
    desk.move((A, 0))
    assert desk.read() == [("a", "release")]


def test_a_tap_that_is_over_before_it_is_read_is_a_press_and_a_release(desk: Desk) -> None:
    desk.move((W, 1), (W, 0))
    desk.type("w")
    assert desk.read() == [("w", "press"), ("w", "release")]


def test_let_go_and_pressed_again_between_two_looks_is_told(desk: Desk) -> None:
    desk.press(W, "w")
    desk.move((W, 0), (W, 1))
    desk.type("w")
    assert desk.read() == [("w", "release"), ("w", "press")]


def test_a_repeat_that_comes_after_its_release_is_not_taken_for_another_key(desk: Desk) -> None:
    desk.press(W, "w")
    desk.move((W, 0))
    assert desk.read() == [("w", "release")]
    desk.move((A, 1))
    desk.type("w")  # it was on its way
    assert desk.read() == []
    desk.type("a")
    assert desk.read() == [("a", "press")]


def test_another_layout_is_learned_by_keys_that_are_pressed_alone(desk: Desk) -> None:
    assert desk.press(Q, "a") == [("a", "press")]  # a French keyboard
    desk.move((Q, 0))
    assert desk.read() == [("a", "release")]
    assert desk.press(A, "q") == [("q", "press")]
    desk.move((A, 0), (Q, 1), (W, 1))
    desk.type("aw")
    assert desk.read() == [("q", "release"), ("a", "press"), ("w", "press")]
    desk.move((Q, 0))
    assert desk.read() == [("a", "release")]


def test_what_is_held_with_others_is_no_key_of_its_own_to_learn(desk: Desk) -> None:
    desk.move((SHIFT, 1), (SHIFT, 0), (Q, 1))
    desk.type("a")
    assert desk.read() == [("a", "press")]


def test_a_key_with_shift_or_ctrl_is_its_own(desk: Desk) -> None:
    desk.move((SHIFT, 1))
    assert desk.press(W, "W") == [("W", "press")]
    desk.move((W, 0), (SHIFT, 0))
    assert desk.read() == [("W", "release")]
    assert desk.press(46, "\x03") == [("ctrl-c", "press")]


@pytest.mark.parametrize("event", ["unplugged", "lost"])
def test_what_was_held_is_let_go_when_a_keyboard_goes_or_events_are_lost(desk: Desk, event: str) -> None:
    desk.press(W, "w")
    lost = Change(BOARD, "moved", [RESYNC]) if event == "lost" else Change(BOARD, "unplugged")
    desk.devices.changes.append(lost)
    assert desk.read() == [("w", "release")]
    assert desk.keys.told is (event == "lost")


def test_a_keyboard_that_is_plugged_in_later_counts(desk: Desk) -> None:
    desk.devices.changes.append(Change(BOARD, "unplugged"))
    desk.read()
    desk.devices.changes.append(Change(BOARD, "plugged"))
    desk.read()
    assert desk.press(W, "w") == [("w", "press")]


@pytest.mark.parametrize(
    ("refused", "words"),
    [({}, "expected a keyboard at this machine, found none"), ({"/dev/input/event0": "Keys"}, "group input")],
)
def test_where_no_keyboard_can_be_read_it_says_why(refused: dict[str, str], words: str) -> None:
    devices = Devices()
    devices.refused = refused
    with pytest.raises(DeviceError, match=words):
        ToldKeys(Typed(FakeTerminal()), devices)
    assert devices.closed


def test_a_keyboard_that_is_held_so_drives_while_it_is_and_says_by_what(desk: Desk, car: object) -> None:
    keyboard = Keyboard("hold", typed=desk.keys)
    keyboard.fit(car)
    assert keyboard.certainty == "release told (this machine's keyboard)"
    desk.move((W, 1))
    desk.type("w")
    assert keyboard.read(100.1)
    assert keyboard.stick(100.1).forward == 1.0
    assert all(keyboard.read(101.0 + second) for second in range(10)), "it is held"
    assert keyboard.stick(110.0).deadman
    desk.move((W, 0))
    keyboard.read(110.1)
    assert not keyboard.stick(110.1).deadman


def test_either_wakes_whoever_waits_and_both_are_let_go(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    ear, mouth = os.pipe()
    monkeypatch.setattr(desk.terminal, "fileno", lambda: ear)
    assert desk.keys.fileno() == desk.keys.fileno()
    desk.keys.close()
    assert desk.devices.closed
    os.close(ear)
    os.close(mouth)


def test_what_has_letters_is_a_keyboard() -> None:
    assert is_keyboard(frozenset(range(1, 90)), frozenset(), "Keys")
    assert not is_keyboard(frozenset({116}), frozenset(), "Power Button")
    assert not is_keyboard(frozenset(range(1, 90)), frozenset({0, 1}), "Pad with keys")
