"""A keyboard whose terminal tells when a key is let go."""

import pytest
from unit.inputs.typist import Typist, pressed

from zteleop.control.stick import Stick
from zteleop.inputs import Wish
from zteleop.inputs.down_keys import RETURNED
from zteleop.inputs.keyboard import ANSWERED_WITHIN
from zteleop.terminal.releases import PING, SILENT

TICK = 0.05
ANSWER = b"\x1b[?62c"
AWAY, BACK = b"\x1b[O", b"\x1b[I"


@pytest.fixture
def told(car):
    typist = Typist("hold", car)
    typist.tell_releases()
    return typist


def hold(typist: Typist, seconds: float, says: bytes = ANSWER) -> list[bool]:
    """Let the time pass in which keys are held and the terminal answers, and say when it was an act."""
    return [typist.type(says, TICK) for _ in range(round(seconds / TICK))]


def test_two_keys_held_drive_and_steer_until_each_is_let_go(told):
    told.press("w")
    told.press("d", after=1.0)
    assert told.stick() == Stick(1.0, -1.0, deadman=True)
    told.release("w", after=0.2)
    assert told.stick() == Stick(0.0, -1.0, deadman=True)
    told.release("d", after=0.2)
    assert told.stick() == Stick()


def test_the_other_key_reverses_the_steering_at_once_and_the_first_resumes(told):
    told.press("a")
    told.press("d", after=0.3)
    assert told.stick().turn == -1.0
    told.release("d", after=0.3)
    assert told.stick().turn == 1.0


def test_a_key_that_is_held_is_an_act_at_every_look_and_never_idle(told):
    told.press("w")
    assert all(hold(told, 30.0))
    assert told.stick().deadman
    told.release("w")
    assert not any(hold(told, 1.0))


def test_a_repeat_arms_nothing(told):
    told.press("w")
    told.type(b" ")
    for _ in range(20):
        told.type(pressed("w", 2), after=0.04)
        assert told.stick() == Stick()
    told.release("w")
    told.press("w")
    assert told.stick().deadman


def test_let_go_and_pressed_anew_within_one_read_was_a_rest(told):
    told.press("w")
    told.keyboard.rested = False
    told.type(pressed("w", 3) + pressed("w"))
    assert told.keyboard.rested
    assert told.stick().deadman


def test_with_the_focus_everything_is_let_go_for_good(told):
    told.press("w")
    told.type(AWAY)
    assert told.stick() == Stick()
    assert told.keyboard.certainty.startswith("no focus")
    told.type(BACK + pressed("w"), after=RETURNED / 2)
    assert told.stick() == Stick(), "alacritty tells a key that was down all the time as pressed"
    told.type(pressed("w", 2), after=RETURNED)
    assert told.stick() == Stick(), "and kitty as repeated"
    told.type(pressed("w", 3) + pressed("w"))
    assert told.stick().deadman


def test_levers_go_to_neutral_with_the_focus(car):
    typist = Typist("step", car)
    typist.tell_releases()
    typist.press("w", "a")
    assert typist.ticks() == (390, 371)
    typist.type(AWAY)
    assert typist.ticks() is None


def test_a_terminal_that_falls_silent_lets_go_of_everything(told):
    told.press("w")
    acts = hold(told, 2.0, says=b"")
    assert told.terminal.said.count(PING) >= 3
    assert SILENT <= acts.index(False) * TICK <= SILENT + 3 * TICK
    told.type(ANSWER + pressed("w", 2))
    assert told.stick() == Stick(), "what comes when the link is back is old"


def test_nobody_is_asked_while_nothing_is_held(told):
    before = told.terminal.said
    hold(told, 2.0, says=b"")
    assert told.terminal.said == before


def test_each_press_and_repeat_is_a_step_of_a_lever_and_a_release_is_none(car):
    typist = Typist("step", car)
    typist.tell_releases()
    typist.type(pressed("w") + pressed("w", 2) * 3 + pressed("w", 3))
    assert typist.ticks() == (375, 374)


def test_a_key_held_through_a_stop_steps_on_only_when_pressed_anew(car):
    typist = Typist("step", car)
    typist.tell_releases()
    typist.press("w")
    typist.type(b"\x1b[127;1:1u")
    assert typist.wish() is Wish.STOP
    typist.type(pressed("w", 2), after=0.05)
    assert typist.ticks() is None
    typist.type(pressed("w", 3) + pressed("w"), after=0.05)
    assert typist.ticks() == (375, 371)


def test_ctrl_with_a_key_that_is_down_leaves_no_key_behind(told):
    told.press("w")
    told.type(b"\x1b[119;5:3u")
    assert told.stick() == Stick()


def test_ctrl_c_quits_although_the_protocol_swallows_its_signal(told):
    told.press("w")
    told.type(b"\x1b[99;5u")
    assert told.keyboard.finished
    assert told.stick() == Stick()


def test_it_says_how_sure_it_is(car, told):
    assert told.keyboard.certainty == "release told (kitty protocol)"
    assert Typist("hold", car).keyboard.certainty.startswith("release guessed; ")


class Slow:
    """A clock that passes by a tenth of a second at each look."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        self.now += 0.1
        return self.now


def test_a_terminal_that_never_answers_is_not_waited_for_long(car, monkeypatch):
    typist, clock, waits = Typist("hold", car), Slow(), []
    typist.terminal.answers = True
    monkeypatch.setattr("select.select", lambda read, write, error, seconds: waits.append(seconds))
    typist.keyboard.settle(clock)
    assert clock.now <= 100.0 + ANSWERED_WITHIN + 0.3
    assert all(0 < wait <= ANSWERED_WITHIN for wait in waits)
    assert not typist.keyboard.tells_releases


def test_what_a_terminal_answers_is_waited_for(car, monkeypatch):
    typist = Typist("hold", car)
    typist.terminal.answers = True

    def answer(*arguments: object) -> None:
        typist.terminal.typed = b"\x1b[?15u\x1b[?62c"

    monkeypatch.setattr("select.select", answer)
    typist.keyboard.settle(lambda: 100.0)
    assert typist.keyboard.tells_releases


@pytest.mark.parametrize("drive", ["step", "hold"])
def test_what_is_typed_before_it_begins_moves_nothing_and_whoever_stops_or_quits_does(car, drive):
    typist = Typist(drive, car)
    for typed, wish, finished in ((b"wr", None, False), (b"w\x7f", Wish.STOP, False), (b"w\x03", None, True)):
        typist.terminal.typed = typed
        typist.keyboard.settle(lambda: typist.now)
        assert typist.stick() == Stick()
        assert (typist.wish(), typist.keyboard.finished) == (wish, finished)


def test_a_terminal_that_no_longer_tells_releases_has_let_go_of_what_was_held(told):
    told.press("w")
    told.type(b"\x1b[?0u")
    assert told.stick() == Stick()
    assert not told.keyboard.tells_releases
    assert not told.type(b"", after=TICK), "no key is known to be down"


def test_where_releases_are_told_each_press_switches_and_no_repeat_does(car):
    typist = Typist("hold", car, keys={"l": "toggle lights"})
    typist.tell_releases()
    for _ in range(3):
        typist.press("l", after=0.02)
        typist.type(pressed("l", 2), after=0.02)
        typist.release("l", after=0.02)
    assert typist.keyboard.switches == {"lights": True}
