"""From a key to a wheel: a person at a terminal, an actuator, a simulated car, each a process of its own."""

import re
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

import pytest
from rig import NEUTRAL, Rig, Terminal, Watch, every, hear, repeating, until

from zteleop.messages import Odometry

UP, DOWN, RIGHT, LEFT = "\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D"
OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
REPEAT = 0.04


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("line")) as bench:
        bench.actuator()
        bench.join("sim")
        yield bench


@pytest.fixture
def own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """A robot for those who switch it off."""
    with Rig(tmp_path_factory.mktemp("own")) as bench:
        yield bench


class Left(NamedTuple):
    """A robot whose operator has pressed two keys and gone away."""

    rig: Rig
    keyboard: Terminal
    watch: Watch


@pytest.fixture(scope="module", autouse=True)
def left(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Left]:
    """Begin early what takes five seconds; the others run meanwhile."""
    with Rig(tmp_path_factory.mktemp("left")) as bench:
        bench.actuator()
        keyboard = bench.keyboard()
        keyboard.shows(" idle")
        with Watch(bench) as watch:
            keyboard.type(LEFT + UP)
            yield Left(bench, keyboard, watch)


@contextmanager
def operating(rig: Rig, keyboard: Terminal) -> Iterator[Terminal]:
    """Wait until a keyboard knows the robot; give the robot to the next test at rest."""
    try:
        keyboard.shows(" idle")
        yield keyboard
    finally:
        if keyboard.process.poll() is None:
            keyboard.type("q")
            assert keyboard.ends() == 0
        stands(rig, *NEUTRAL)


@pytest.fixture
def steps(rig: Rig) -> Iterator[Terminal]:
    with operating(rig, rig.keyboard()) as keyboard:
        yield keyboard


@pytest.fixture
def held(rig: Rig) -> Iterator[Terminal]:
    with operating(rig, rig.keyboard("--drive", "hold")) as keyboard:
        yield keyboard


def stands(rig: Rig, steering: int, throttle: int) -> None:
    until(lambda: rig.ticks == (steering, throttle), f"{steering}, {throttle} on the chip")


def drives(rig: Rig) -> None:
    until(lambda: rig.ticks[1] > NEUTRAL[1], "the throttle above neutral")


def stays_neutral(rig: Rig, seconds: float) -> None:
    for _ in every(0.005, round(seconds / 0.005)):
        assert rig.ticks == NEUTRAL


def test_keys_move_levers_that_stay_and_end_exactly_at_the_limit(rig: Rig, steps: Terminal) -> None:
    steps.type(LEFT)
    stands(rig, 390, 370)
    steps.shows(f"{OUTPUT}[390, 370]", "you operate")
    steps.type(UP * 10)
    stands(rig, 390, 383)
    steps.type(RIGHT * 9)
    stands(rig, 290, 383)
    steps.shows(f"{OUTPUT}[290, 383]", "steering  ▕      │██████▏  right 6/6")
    steps.type(" ")
    stands(rig, 290, 370)
    steps.type("x")
    stands(rig, *NEUTRAL)
    steps.shows(f"{OUTPUT}[375, 370]")


def test_a_question_mark_shows_every_key_and_driving_goes_on(rig: Rig, steps: Terminal) -> None:
    steps.type("?")
    steps.shows("up w", "forward, a step each press", "backspace", "STOP the robot, until it is released")
    steps.type(LEFT)
    stands(rig, 390, 370)
    steps.type("?")
    steps.shows("left 1/6", "allowed")


def test_the_car_moves_and_the_screen_shows_where_in_colours(rig: Rig, steps: Terminal) -> None:
    node = rig.node()
    odoms = node.subscription("odom", Odometry)
    steps.type(UP * 10)
    moved = hear(odoms, lambda odom: odom.twist.twist.linear.x > 0.1, "a car that moves")
    assert moved.pose.pose.position.x != 0
    steps.shows("driving", "moving    +0.", "place")
    assert not without_color(steps.output)


def test_q_leaves_neutral_on_the_chip_and_the_terminal_as_found(rig: Rig, steps: Terminal) -> None:
    assert steps.modes() != steps.found
    steps.type(LEFT + UP)
    stands(rig, 390, 374)
    steps.type("q")
    assert steps.ends() == 0
    stands(rig, *NEUTRAL)
    steps.is_as_found()


def test_sigterm_leaves_neutral_on_the_chip_and_the_terminal_as_found(rig: Rig, steps: Terminal) -> None:
    steps.type(LEFT + UP)
    stands(rig, 390, 374)
    steps.signal(signal.SIGTERM)
    stands(rig, *NEUTRAL)
    assert steps.ends() == 143
    steps.is_as_found()


def test_a_repeating_key_drives_and_its_end_is_neutral(rig: Rig, held: Terminal) -> None:
    with repeating(lambda: held.type("w"), REPEAT), Watch(rig) as watch:
        until(lambda: rig.ticks[1] >= NEUTRAL[1] + 20, "the speed that the screen says")
        held.shows("asked     +0.50 m/s", "driving")
    stands(rig, *NEUTRAL)
    held.shows(" idle")  # it was let go, and did not fall silent
    grown = {throttle for _, throttle in watch.seen}
    assert len(grown) >= 6, f"no ramp of acceleration: {grown}"


def test_u_raises_the_speed_shown_and_moves_nothing(rig: Rig, held: Terminal) -> None:
    held.shows("full      0.50 m/s")
    with Watch(rig) as watch:
        held.type("u")
        held.shows("full      0.55 m/s")
        held.type("jj")
        held.shows("full      0.45 m/s")
    assert watch.seen == {NEUTRAL}


def test_without_an_actuator_the_screen_says_so_and_what_was_pressed_never_drives(own: Rig) -> None:
    keyboard = own.keyboard()
    keyboard.shows(f"no actuator heard on robot bench (nothing answers at {own.endpoint}: is the")
    keyboard.type(LEFT + UP)
    keyboard.shows("asked     [390, 374]  not obeyed", f"{OUTPUT}[-, -]")
    own.actuator()
    keyboard.shows("idle", "nobody operates", f"{OUTPUT}[375, 370]")
    stays_neutral(own, 0.7)  # and nobody can have held a key for so long without a repeat
    keyboard.type(LEFT + UP)
    stands(own, 390, 374)


def test_a_key_held_through_a_restart_does_not_drive_until_let_go(own: Rig) -> None:
    actuator = own.actuator()
    keyboard = own.keyboard("--drive", "hold")
    keyboard.shows("nobody operates")
    with repeating(lambda: keyboard.type("w"), REPEAT):
        drives(own)
        actuator.signal(signal.SIGKILL)
        actuator.ends()
        own.actuator()
        stands(own, *NEUTRAL)
        stays_neutral(own, 0.5)
        keyboard.shows("nobody operates")
    stays_neutral(own, 0.7)
    with repeating(lambda: keyboard.type("w"), REPEAT):
        drives(own)


def narrow(output: bytes) -> bool:
    return b"step drive" in output


def without_escapes(output: bytes) -> bool:
    return b"\x1b" not in output


def without_color(output: bytes) -> bool:
    return not re.search(rb"\x1b\[([0-9;]*;)?(3[0-7]|9[0-7])m", output)


@pytest.mark.parametrize(
    ("columns", "environment", "shown", "fits"),
    [
        (20, {}, ["● driving", "out      [390, 374]"], narrow),
        (80, {"TERM": "dumb"}, ["driving", "[390, 374]"], without_escapes),
        (80, {"LC_ALL": "", "LANG": "C"}, ["* driving", f"{OUTPUT}[390, 374]"], bytes.isascii),
        (80, {"NO_COLOR": "1"}, ["● driving", f"{OUTPUT}[390, 374]"], without_color),
    ],
    ids=["20 columns", "TERM=dumb", "LANG=C", "NO_COLOR"],
)
def test_a_poor_terminal_drives_as_well(
    rig: Rig,
    columns: int,
    environment: dict[str, str],
    shown: list[str],
    fits: Callable[[bytes], bool],
) -> None:
    with operating(rig, rig.keyboard(columns=columns, environment=environment)) as keyboard:
        keyboard.type(LEFT + UP)
        stands(rig, 390, 374)
        keyboard.shows(*shown)
        assert fits(keyboard.output)
    keyboard.is_as_found()


def test_a_window_may_be_resized(rig: Rig, steps: Terminal) -> None:
    for columns, rows, output in (
        (20, 8, "out      "),
        (132, 40, OUTPUT),
        (20, 1, "idle  "),
        (80, 24, OUTPUT),
    ):
        steps.resize(columns, rows)
        steps.shows(f"{output}[375, 370]")
    steps.type(LEFT)
    stands(rig, 390, 370)


def test_a_window_that_is_small_for_a_moment_is_drawn_anew(rig: Rig, steps: Terminal) -> None:
    steps.resize(1, 1)
    steps.resize(80, 24)
    steps.type(LEFT)
    steps.shows("step drive", f"{OUTPUT}[390, 370]", "steering  ▕", "throttle  ▕", "q quit")


def test_of_two_keyboards_the_first_drives_until_it_lets_go(rig: Rig, steps: Terminal) -> None:
    with operating(rig, rig.keyboard()) as second:
        steps.type(UP * 5)
        stands(rig, 375, 378)
        with Watch(rig) as watch:
            second.type(LEFT)
            second.shows("driving, keyboard", " operates", f"{OUTPUT}[375, 378]")
            second.shows("asked     [390, 370]  not obeyed", "you are not obeyed: keyboard ")
            assert re.search(r"you are not obeyed: keyboard \w{4} drives this source", second.screen)
        assert watch.seen == {(375, 378)}
        second.type("x")
        steps.type("x")
        stands(rig, *NEUTRAL)
        second.shows("nobody operates")  # whoever begins before he has heard so began too early
        second.type(LEFT)
        stands(rig, 390, 370)
        second.shows("you operate")


def test_whoever_lets_go_and_presses_again_in_one_breath_begins_anew(rig: Rig, steps: Terminal) -> None:
    """Over a slow link several keys come at once."""
    with operating(rig, rig.keyboard()) as second:
        steps.type(UP * 5)
        stands(rig, 375, 378)
        second.type(LEFT)
        second.shows(" drives this source")
        steps.type("x")
        stands(rig, *NEUTRAL)
        second.shows("nobody operates")
        second.type("x" + LEFT)
        stands(rig, 390, 370)


def test_without_a_terminal_it_says_so(rig: Rig) -> None:
    keyboard = rig.join("keyboard")
    assert keyboard.ends() == 1
    assert "expected a terminal to read keys from" in keyboard.text
    assert len(keyboard.lines) == 1


def test_five_seconds_without_a_key_bring_steering_and_throttle_to_neutral(left: Left) -> None:
    left.keyboard.shows(f"{OUTPUT}[375, 370]", "you ask for nothing")
    stands(left.rig, *NEUTRAL)
    assert [ticks for _, ticks in left.watch.changes][-2:] == [(390, 374), NEUTRAL]
    left.keyboard.type(UP)
    stands(left.rig, 375, 374)
