"""A pad and the keys beside it, as one input."""

import pytest
from unit.inputs.test_gamepad import LB, REST, START, B, Pads, Y

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs import Wish
from zteleop.inputs.console import Console
from zteleop.inputs.gamepad import RELEASE_HELD, Gamepad
from zteleop.inputs.gamepad_map import FORGET, Moved
from zteleop.inputs.keyboard import Keyboard
from zteleop.testing import FakeTerminal


class Bench:
    def __init__(self, tank) -> None:
        self.terminal, self.pads, self.now = FakeTerminal(), Pads(), 100.0
        self.console = Console(
            Gamepad(self.pads, None, Speeds(0.25, 0.5)),
            Keyboard("hold", keymap="stop", terminal=self.terminal),
        )
        self.console.fit(tank)
        self.pads.name = "Pad"
        self.pads.moved += [FORGET, *(Moved(*item) for item in REST.items())]
        self.read()

    def read(self, after: float = 0.05) -> bool:
        self.now += after
        return self.console.read(self.now)

    def move(self, **moved: float) -> bool:
        self.pads.moved += [Moved(*item) for item in moved.items()]
        return self.read()

    def type(self, data: bytes) -> bool:
        self.terminal.typed = data
        return self.read()

    @property
    def stick(self) -> Stick:
        return self.console.stick(self.now)

    def wish(self) -> Wish | None:
        wish, self.console.wish = self.console.wish, None
        return wish


@pytest.fixture
def bench(tank) -> Bench:
    return Bench(tank)


def test_the_pad_drives_and_no_key_does(bench):
    assert not bench.type(b"wwww\x1b[A")
    assert bench.stick == Stick()
    words = "up does nothing here; backspace stops the robot, ? shows what each key does"
    assert bench.console.in_vain == words
    assert bench.move(**{LB: 1.0, Y: -1.0})
    assert bench.stick == Stick(1.0, 0.0, deadman=True)
    assert bench.type(b"s\x1b[B"), "it is held, whatever is typed"
    assert bench.stick == Stick(1.0, 0.0, deadman=True)


@pytest.mark.parametrize("stops", [lambda bench: bench.type(b"\x7f"), lambda bench: bench.move(**{B: 1.0})])
def test_a_key_stops_the_robot_as_a_button_does(bench, stops):
    bench.move(**{LB: 1.0, Y: -1.0})
    stops(bench)
    assert bench.wish() is Wish.STOP
    assert bench.wish() is None


def test_a_stop_at_either_wins_over_a_release_at_the_other(bench):
    bench.move(**{START: 1.0})
    bench.pads.moved.append(Moved(START, 1.0))
    bench.read(RELEASE_HELD)
    bench.type(b"\x7f")
    assert bench.wish() is Wish.STOP


@pytest.mark.parametrize("end", [b"q", b"\x03", b"\x1a"])
def test_whoever_quits_or_suspends_holds_the_pad_no_more(bench, end):
    bench.move(**{LB: 1.0, Y: -1.0})
    assert not bench.type(end)
    assert bench.stick == Stick()
    assert bench.console.finished is (end != b"\x1a")
    assert bench.console.suspending is (end == b"\x1a")


def test_after_a_suspension_the_pad_must_be_let_go(bench):
    bench.move(**{LB: 1.0, Y: -1.0})
    bench.type(b"\x1a")
    bench.console.suspend(bench.now)
    assert not bench.console.suspending
    assert not bench.read()
    bench.move(**{LB: 0.0, Y: 0.0})
    assert bench.move(**{LB: 1.0})


def test_a_terminal_that_hangs_up_ends_the_drive(bench):
    bench.move(**{LB: 1.0, Y: -1.0})
    bench.terminal.gone = True
    assert not bench.read()
    assert bench.console.finished
    assert bench.stick == Stick()


def test_let_go_and_held_again_between_two_looks_is_a_rest(bench):
    bench.move(**{LB: 1.0, Y: -1.0})
    bench.console.rested = False
    bench.pads.moved += [Moved(LB, 0.0), Moved(LB, 1.0)]
    bench.read()
    assert bench.console.rested


def test_its_help_tells_buttons_and_keys_while_somebody_asks(bench):
    assert bench.console.help == []
    bench.type(b"?")
    told = dict(bench.console.help)
    assert told["LB"] == "to drive, while it is held"
    assert told["B"] == told["backspace"]
    assert "forward" not in " ".join(told.values())


def test_a_keyboard_that_cannot_be_opened_leaves_the_pad(tank):
    bench = Bench(tank)

    def fail() -> None:
        raise OSError("no terminal")

    bench.terminal.__class__ = type("Broken", (FakeTerminal,), {"__enter__": lambda self: fail()})
    with pytest.raises(OSError, match="no terminal"), bench.console:
        pass
    assert bench.pads.entered == 0
