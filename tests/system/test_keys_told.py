"""`zteleop keyboard` in a terminal that tells when a key is let go."""

import signal
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Rig, Terminal, until


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("told")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture
def keyboard(rig: Rig) -> Iterator[Terminal]:
    terminal = rig.keyboard(tells_releases=True)
    terminal.shows("hold drive", "idle, nobody operates", "keys      release told (kitty protocol)")
    yield terminal
    terminal.key("q")
    assert terminal.ends() == 0
    assert terminal.flags == [0], "the protocol is switched off again"
    terminal.is_as_found()


def steers(rig: Rig, left: bool) -> bool:
    return rig.ticks[0] is not None and (
        rig.ticks[0] - NEUTRAL[0] > 20 if left else NEUTRAL[0] - rig.ticks[0] > 20
    )


def test_two_keys_that_are_held_drive_and_steer_and_each_ends_when_it_is_let_go(
    rig: Rig, keyboard: Terminal
) -> None:
    keyboard.key("up")
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")
    keyboard.key("right")
    until(lambda: steers(rig, left=False) and rig.ticks[1] > NEUTRAL[1], "both")
    keyboard.key("left")
    until(lambda: steers(rig, left=True), "the other way")
    keyboard.key("left", "release")
    until(lambda: steers(rig, left=False), "the first again")
    keyboard.shows("driving, you operate")
    keyboard.key("right", "release")
    until(lambda: rig.ticks[0] == NEUTRAL[0] and rig.ticks[1] > NEUTRAL[1], "straight on")
    keyboard.key("up", "release")
    until(lambda: rig.ticks == NEUTRAL, "rest")
    keyboard.shows("idle, nobody operates")


def test_the_keys_of_the_course_drive_and_any_other_key_is_neutral(rig: Rig) -> None:
    terminal = rig.keyboard("--keymap", "course", tells_releases=True)
    terminal.shows("hold drive", "idle, nobody operates")
    terminal.key("w")
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "forward")
    terminal.key("a")
    until(lambda: steers(rig, left=True), "left")
    terminal.key("a", "release")
    terminal.key("d")
    until(lambda: steers(rig, left=False), "right")
    terminal.key("p")
    until(lambda: rig.ticks == NEUTRAL, "rest, though w and d are held")
    terminal.key("q")
    assert terminal.ends() == 0


def test_what_is_let_go_unseen_stops_and_arms_nothing(rig: Rig, keyboard: Terminal) -> None:
    for away, back in (("", ""), ("\x1b[O", "\x1b[I")):
        keyboard.key("w")
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")
        keyboard.silent = not away
        keyboard.type(away)
        until(lambda: rig.ticks == NEUTRAL, "rest")
        keyboard.silent = False
        keyboard.type(back)
        keyboard.key("w", "repeat")
        keyboard.shows("idle, nobody operates")
        assert rig.ticks == NEUTRAL
        keyboard.key("w", "release")
        keyboard.shows("release told")


def test_a_terminal_that_does_not_tell_says_so_and_drives_in_steps(rig: Rig) -> None:
    keyboard = rig.keyboard()
    keyboard.shows("step drive", "keys      release guessed; kitty, foot, ghostty tell it")
    keyboard.type("q")
    assert keyboard.ends() == 0
    assert b"\x1b[>15u" not in keyboard.output


def test_whoever_says_how_drives_so(rig: Rig) -> None:
    keyboard = rig.keyboard("--drive", "step", tells_releases=True)
    keyboard.shows("step drive", "nobody operates", "release told")
    keyboard.key("w")
    keyboard.key("w", "release")
    until(lambda: rig.ticks == (375, 374), "a lever that stays")
    keyboard.key("q")
    assert keyboard.ends() == 0


def test_whoever_is_killed_leaves_the_robot_at_rest_and_the_terminal_as_found(rig: Rig) -> None:
    keyboard = rig.keyboard(tells_releases=True)
    keyboard.shows("hold drive", "idle, nobody operates", "release told")
    keyboard.key("w")
    until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "throttle")
    keyboard.signal(signal.SIGKILL)
    assert keyboard.ends() == -signal.SIGKILL
    until(lambda: rig.ticks == NEUTRAL, "rest")
    until(lambda: keyboard.flags == [0], "the protocol switched off")
    keyboard.is_as_found()


def test_a_map_and_keys_of_ones_own(rig: Rig) -> None:
    rig.set('keymap = "donkey"\nkeys = { f1 = "forward", q = "nothing", z = "quit" }')
    keyboard = rig.keyboard()
    keyboard.shows("nobody operates", "backspace STOP   arrows drive   space throttle off   z quit")
    keyboard.type("\x1bOP" + "wq")
    until(lambda: rig.ticks == (375, 374), "F1 on the chip, and nothing of w")
    keyboard.type("z")
    assert keyboard.ends() == 0
    keyboard = rig.keyboard("--keymap", "twist", "--drive", "step")
    keyboard.shows("nobody operates", "ij,l drive", "z quit")
    keyboard.type("o")
    until(lambda: rig.ticks == (360, 374), "both axes by one key")
    keyboard.type("?")
    keyboard.shows("forward and right, a step each press", "any other")
    keyboard.type("\x03")
    assert keyboard.ends() == 0
