import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.inputs.typist import Typist

from zteleop.control.stick import Speeds, Stick, to_twist
from zteleop.errors import ConfigError
from zteleop.inputs import Wish
from zteleop.inputs.held_keys import FIRST, HELD_BEFORE, REPEATING
from zteleop.inputs.holding import UNCONFIRMED
from zteleop.inputs.keymap import bindings, describe
from zteleop.inputs.wishes import MISSED_FOR
from zteleop.messages import Channel, Vehicle

DELETE = b"\x7f"
UP, DOWN, RIGHT, LEFT = b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D"


@pytest.fixture
def step(car):
    return Typist("step", car)


@pytest.fixture
def hold(car):
    return Typist("hold", car)


@pytest.mark.parametrize("keys", [UP + UP + RIGHT, b"wwd", b"WwD"])
def test_arrows_and_letters_move_the_levers(step, keys):
    assert step.type(keys)
    assert step.ticks() == (360, 372)


def test_nothing_typed_is_no_act(step):
    assert not step.type(b"")
    assert step.stick() == Stick()


def test_space_stops_the_throttle_and_keeps_the_steering(step):
    step.type(UP + LEFT + b" ")
    assert step.ticks() == (390, 370)


def test_x_brings_both_to_neutral(step):
    step.type(UP + LEFT + b"x")
    assert step.ticks() is None


@pytest.mark.parametrize(
    ("keys", "rested"), [(b"x\x1b[D", True), (b"\x1b[C\x1b[D", True), (b"\x1b[D", False), (b" \x1b[D", False)]
)
def test_neutral_between_two_keys_that_came_at_once_is_told(step, keys, rested):
    step.type(b"\x1b[D")
    step.keyboard.rested = False
    step.type(keys)
    assert step.keyboard.rested is rested


@pytest.mark.parametrize("drive", ["step", "hold"])
@pytest.mark.parametrize("key", [DELETE, b"\x08"])
def test_backspace_is_neutral_and_a_wish_to_stop(car, drive, key):
    bench = Typist(drive, car)
    bench.type(UP + LEFT)
    assert bench.stick().deadman
    assert bench.wish() is None
    assert bench.type(key)
    assert bench.stick() == Stick()
    assert bench.wish() is Wish.STOP


@pytest.mark.parametrize("drive", ["step", "hold"])
def test_a_key_held_through_a_stop_must_be_let_go_first(car, drive):
    bench = Typist(drive, car)
    bench.type(UP)
    bench.type(DELETE, after=0.1)
    bench.wish()
    for _ in range(20):
        bench.type(UP, after=0.1)
        assert bench.stick() == Stick()
    bench.type(UP, after=FIRST + 0.01)
    assert bench.stick().forward > 0


@pytest.mark.parametrize("keys", [DELETE + UP + UP, DELETE + b"r", b"r" + DELETE, DELETE + b"r" + UP])
def test_what_is_typed_around_a_stop_neither_drives_nor_releases(step, keys):
    step.type(keys)
    assert step.wish() is Wish.STOP
    assert step.stick() == Stick()


@pytest.mark.parametrize("key", [b"q", b"\x1a"])
def test_a_stop_is_heard_whatever_else_is_asked_in_the_same_breath(step, key):
    step.type(key + DELETE)
    assert step.wish() is Wish.STOP
    step.type(DELETE + b"q", after=1.0)
    assert step.wish() is Wish.STOP


def test_one_can_leave_in_the_same_breath_as_a_stop(step):
    step.type(DELETE + b"q")
    assert step.keyboard.finished


@pytest.mark.parametrize("key", [b"r", b"R"])
def test_r_is_a_wish_to_release_and_moves_nothing(step, key):
    step.type(UP)
    before = step.ticks()
    step.type(key)
    assert step.wish() is Wish.RELEASE
    assert step.ticks() == before


def test_a_stop_key_that_repeats_is_one_wish_and_pressed_again_another(step):
    step.type(DELETE + DELETE)
    assert step.wish() is Wish.STOP
    for _ in range(10):
        step.type(DELETE, after=REPEATING - 0.01)
        assert step.wish() is None
    step.type(DELETE, after=REPEATING + 0.01)
    assert step.wish() is Wish.STOP


def test_a_release_key_held_down_is_one_wish(step):
    step.type(b"r")
    assert step.wish() is Wish.RELEASE
    step.type(b"r", after=FIRST - 0.01)
    assert step.wish() is None
    step.type(b"r", after=FIRST + 0.01)
    assert step.wish() is Wish.RELEASE


def test_a_stop_at_once_after_a_release_counts(step):
    step.type(b"r")
    step.wish()
    step.type(DELETE, after=0.01)
    assert step.wish() is Wish.STOP


@pytest.mark.parametrize("key", [b"q", b"\x03"])
def test_quitting_is_neutral_and_hears_no_more_keys(step, key):
    step.type(UP + key + UP)
    assert step.keyboard.finished
    assert step.stick() == Stick()


@pytest.mark.parametrize("key", [b"z", "é".encode(), b"\x1bw", b"\x1b[1;5A", b"\x04"])
def test_an_unknown_key_does_nothing_but_shows_that_somebody_is_there(step, key):
    step.type(UP)
    before = step.ticks()
    assert step.type(key, after=4.0)
    step.now += 4.0
    assert step.ticks() == before
    assert not step.keyboard.finished


def test_the_end_of_the_terminal_is_the_end(step):
    step.type(UP)
    step.terminal.gone = True
    assert not step.type(b"")
    assert step.keyboard.finished
    assert step.stick() == Stick()


def test_five_seconds_without_a_key_are_neutral_for_good(step):
    step.type(UP + LEFT)
    assert step.stick(after=4.9).deadman
    assert step.keyboard.idle_left(step.now) == pytest.approx(0.1)
    assert step.stick(after=0.1) == Stick()
    assert step.keyboard.idle_left(step.now) is None
    step.type(b"z")
    assert step.stick() == Stick()


def test_a_key_after_a_long_stall_starts_from_neutral(step):
    step.type(UP + UP + UP)
    step.type(UP, after=6.0)
    assert step.ticks() == (375, 371)


def test_a_key_held_for_long_keeps_the_idle_timer_away(step):
    for _ in range(40):
        step.type(UP, after=0.2)
        assert step.stick().deadman


def test_the_robot_may_shorten_the_idle_limit_and_never_lengthen_it(car):
    car.operator_silence = 2.0
    assert Typist("step", car).keyboard.idle_limit == 2.0
    car.operator_silence = 60.0
    assert Typist("step", car).keyboard.idle_limit == 5.0


@pytest.mark.parametrize("drive", ["step", "hold"])
def test_a_key_held_through_a_reset_must_be_let_go_first(car, drive):
    bench = Typist(drive, car)
    bench.type(UP)
    bench.keyboard.reset(bench.now + 0.1)
    assert bench.stick() == Stick()
    for _ in range(20):
        bench.type(UP, after=0.1)
        assert bench.stick() == Stick()
    bench.type(UP, after=FIRST + 0.01)
    assert bench.stick().forward > 0


def test_held_keys_drive_while_held(hold):
    hold.type(UP + LEFT)
    assert hold.stick(after=0.5) == Stick(UNCONFIRMED, 1.0, True)
    assert hold.stick(after=0.2) == Stick()


@pytest.mark.parametrize("key", [b" ", b"x"])
def test_space_lets_held_keys_go(hold, key):
    hold.type(UP + key)
    assert hold.stick() == Stick()


def test_speed_keys_change_speeds_by_a_tenth_and_move_nothing(tank):
    bench = Typist("hold", tank, speeds=Speeds(0.2, 1.0))
    bench.type(b"uk")
    assert bench.keyboard.speeds.forward == pytest.approx(0.22)
    assert bench.keyboard.speeds.turn == pytest.approx(0.9)
    bench.type(b"ji")
    assert bench.keyboard.speeds.forward == pytest.approx(0.198)
    assert bench.keyboard.speeds.turn == pytest.approx(0.99)
    assert bench.stick() == Stick()


def test_speeds_stay_between_a_crawl_and_what_the_robot_can(tank):
    bench = Typist("hold", tank)
    assert bench.keyboard.speeds == Speeds(0.3, 1.0)
    bench.type(b"u" * 50 + b"i" * 50)
    assert bench.keyboard.speeds == Speeds(0.3, 1.5)
    bench.type(b"j" * 500 + b"k" * 500)
    assert bench.keyboard.speeds.forward > 0
    bench.type(b"u" * 50)
    assert bench.keyboard.speeds.forward == 0.3


def test_ctrl_z_is_neutral_first_and_stops_when_told(step):
    step.type(UP + b"\x1a" + UP)
    assert step.keyboard.suspending
    assert step.stick() == Stick()
    step.type(UP, after=5.0)
    assert step.stick() == Stick()
    step.keyboard.suspend(step.now)
    assert step.terminal.calls == ["suspend"]
    assert not step.keyboard.suspending
    step.type(UP, after=FIRST + 0.01)
    assert step.stick().deadman


def test_a_stop_from_outside_is_neutral(step):
    step.type(UP)
    step.terminal.resumed += 1
    step.type(b"")
    assert step.stick() == Stick()


def test_ctrl_l_draws_anew(step):
    step.type(b"\x0c")
    assert step.terminal.calls == ["redraw"]


def test_a_lone_escape_is_an_act_and_nothing_else(step):
    assert not step.type(b"\x1b")
    assert step.type(b"", after=0.1)
    assert not step.keyboard.finished


def test_a_paste_does_not_drive(step):
    assert not step.type(b"\x1b[200~wwwaaaq\x1b[201~")
    assert step.stick() == Stick()


def test_keys_can_be_bound_without_touching_code(car):
    bench = Typist("step", car, keys={"8": "forward", "Q": "neutral"})
    bench.type(b"88")
    assert bench.ticks() == (375, 372)
    bench.type(b"Q")
    assert bench.ticks() is None
    assert not bench.keyboard.finished
    with pytest.raises(ConfigError):
        Typist("step", car, keys={"8": "fly"})


def test_without_a_robot_it_stays_usable():
    bench = Typist("step", None)
    bench.type(UP + LEFT + b" xuk")
    assert bench.stick() == Stick()


def test_another_calibration_is_neutral_and_needs_a_fresh_press(step, car):
    step.type(UP)
    car.channels[1] = Channel("throttle", 0, 1.0, 2.0, 3.0, 340, 370, 400, 0)
    step.keyboard.fit(car)
    step.type(UP, after=0.1)
    assert step.stick() == Stick()


def test_the_terminal_is_entered_and_left(step):
    with step.keyboard as keyboard:
        step.type(UP)
        assert keyboard.fileno() == 7
    assert step.terminal.calls == ["enter", "exit"]
    assert step.stick() == Stick()


CHUNKS = st.one_of(
    st.sampled_from([UP, DOWN, LEFT, RIGHT, b"w", b" ", b"x", b"u", b"i", b"r", DELETE]),
    st.binary(max_size=3),
)


@given(st.sampled_from(["step", "hold"]), st.lists(st.tuples(CHUNKS, st.floats(0, 6))), st.integers(-1, 60))
def test_any_keys_give_a_stick_in_range(drive, chunks, reset_at):
    channels = [
        Channel(name, i, 1.0, 2.0, 3.0, 290, 375, 460, 0) for i, name in enumerate(("steering", "throttle"))
    ]
    bench = Typist(drive, Vehicle("ackermann", channels, 1.0, 2.0, 0.25, 0.4, 5.0, 4.08, True, 9.0))
    for index, (data, after) in enumerate(chunks):
        bench.type(data, after)
        stick = bench.stick()
        assert not (bench.wish() is Wish.STOP and stick.deadman)
        assert -1 <= stick.forward <= 1
        assert -1 <= stick.turn <= 1
        assert bench.ticks() is None or all(290 <= ticks <= 460 for ticks in bench.ticks())
        if index == reset_at:
            bench.keyboard.reset(bench.now)
            assert bench.stick() == Stick()
    assert bench.stick(after=5.01) == Stick()


@pytest.mark.parametrize("drive", ["step", "hold"])
def test_a_question_mark_shows_what_each_key_does_and_hides_it_again(car, drive):
    typist = Typist(drive, car, keys={"h": "forward"})
    assert typist.keyboard.help == []
    typist.type(b"?")
    shown = dict(typist.keyboard.help)
    assert shown["up w h"] == "forward" + (", a step each press" if drive == "step" else ", while it is held")
    assert shown["u"].endswith("with --drive hold") == (drive == "step")
    assert shown["backspace"].startswith("STOP")
    assert typist.ticks() is None
    typist.type(b"?")
    assert typist.keyboard.help == []


def test_one_key_may_push_both_axes(car):
    for drive, expected in (("hold", Stick(UNCONFIRMED, -1.0, deadman=True)), ("step", None)):
        typist = Typist(drive, car, keymap="twist")
        typist.type(b"o")
        assert typist.stick() == expected or typist.ticks() == (360, 371)
        typist.type(b"k", after=0.1)
        assert typist.stick() == Stick()


def test_a_map_may_bind_every_other_key(car):
    typist = Typist("step", car, keymap="course")
    typist.type(b"wd")
    assert typist.ticks() == (360, 371)
    typist.type(b"\x1b[A")
    assert typist.ticks() is None, "an arrow is no key of that map"
    plain = Typist("step", car, keymap="wasd")
    plain.type(b"w\x1b[A7")
    assert plain.ticks() == (375, 371)


def test_both_speeds_change_by_one_key(car):
    typist = Typist("hold", car, keymap="twist", speeds=Speeds(0.5, 1.0))
    typist.type(b"q")
    assert typist.keyboard.speeds == Speeds(pytest.approx(0.55), pytest.approx(1.1))
    typist.type(b"z")
    assert typist.keyboard.speeds == Speeds(pytest.approx(0.495), pytest.approx(0.99))


def test_a_key_can_be_unbound(car):
    typist = Typist("step", car, keys={"w": "nothing"})
    typist.type(b"w")
    assert typist.ticks() is None
    assert typist.keyboard.bound["forward"] == "up"


def test_a_key_that_does_nothing_says_so_for_a_moment(step):
    step.type(b"y")
    words = "y does nothing here; backspace stops the robot, ? shows what each key does"
    assert step.keyboard.in_vain == words
    step.type(b"", after=MISSED_FOR)
    assert not step.keyboard.in_vain
    step.type(b"y")
    step.type(UP)
    assert not step.keyboard.in_vain, "what was pressed last does something"


def test_a_key_that_is_let_go_or_bound_to_nothing_on_purpose_says_nothing(car):
    typist = Typist("step", car, keys={"w": "nothing"})
    typist.type(b"w")
    typist.type(b"\x1b[121;1:3u")
    assert not typist.keyboard.in_vain


def test_taps_that_follow_a_reset_too_soon_are_told(step):
    step.type(UP)
    step.keyboard.reset(step.now)
    step.type(UP, after=0.36)
    assert step.ticks() is None
    assert step.keyboard.in_vain == HELD_BEFORE
    step.type(UP, after=FIRST + 0.01)
    assert step.ticks() == (375, 371)
    assert "guessed" in step.keyboard.certainty


def test_a_key_that_backs_to_the_left_does_so_on_wheels_that_steer_and_on_tracks(car, tank):
    for vehicle, turn in ((car, 1.0), (tank, -1.0)):
        typist = Typist("hold", vehicle, keymap="twist")
        typist.type(b"mm")
        assert typist.stick() == Stick(-1.0, turn, deadman=True)
        twist = to_twist(typist.stick(), Speeds(0.3, 1.0), vehicle)
        assert twist.linear.x < 0
        assert twist.angular.z < 0, "as teleop_twist_keyboard"


def test_a_key_may_be_a_switch_once_for_each_time_it_is_held(car):
    typist = Typist("step", car, keys={"l": "toggle lights", "h": "toggle horn"})
    assert typist.keyboard.about[1] == ("switches", "lights off, horn off")
    for _ in range(4):  # an even number, which would switch it off again
        typist.type(b"l", after=0.5)
    assert typist.keyboard.switches == {"lights": True, "horn": False}
    typist.type(b"lh", after=FIRST + 0.01)
    assert typist.keyboard.switches == {"lights": False, "horn": True}
    assert typist.keyboard.about[1] == ("switches", "lights off, horn on")
    assert typist.stick() == Stick(), "no switch drives"
    assert ("l", "toggle lights, on or off") in describe(bindings({"l": "toggle lights"}))
