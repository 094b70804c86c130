import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.stick import Speeds, Stick, to_twist
from zteleop.errors import ConfigError
from zteleop.inputs import Wish
from zteleop.inputs.gamepad import RELEASE_HELD, Gamepad
from zteleop.inputs.gamepad_map import FORGET, GamepadSettings, Moved
from zteleop.messages import Channel, Vehicle

LB, RB, B, START, X, Y = "BTN_TL", "BTN_TR", "BTN_EAST", "BTN_START", "ABS_X", "ABS_Y"
REST = {LB: 0.0, RB: 0.0, B: 0.0, START: 0.0, X: 0.0, Y: 0.0}
STEP = 0.05


class Pads:
    """One pad of which a test moves the controls."""

    def __init__(self) -> None:
        self.name = self.trouble = ""
        self.names: list[str] = []
        self.moved: list[Moved] = []
        self.entered = 0

    def fileno(self) -> int:
        return 9

    def read(self, now: float) -> list[Moved]:
        moved, self.moved = self.moved, []
        return moved

    def __enter__(self) -> "Pads":
        self.entered += 1
        return self

    def __exit__(self, *exc: object) -> None:
        self.entered -= 1


class Player:
    def __init__(self, vehicle: Vehicle | None = None, **settings: object) -> None:
        self.pads = Pads()
        self.gamepad = Gamepad(self.pads, GamepadSettings(**settings), Speeds(0.25, 0.5))
        self.now = 100.0
        if vehicle:
            self.gamepad.fit(vehicle)

    def plug(self, name: str = "Pad", **found: float) -> None:
        self.pads.name = name
        self.pads.moved += [FORGET, *(Moved(*item) for item in {**REST, **found}.items())]
        self.read()

    def unplug(self) -> bool:
        self.pads.name = ""
        self.pads.moved.append(FORGET)
        return self.read()

    def move(self, *moves: dict[str, float], after: float = STEP) -> bool:
        for move in moves:
            self.pads.moved += [Moved(*item) for item in move.items()]
        return self.read(after)

    def read(self, after: float = STEP) -> bool:
        self.now += after
        return self.gamepad.read(self.now)

    @property
    def stick(self) -> Stick:
        return self.gamepad.stick(self.now)

    def wish(self) -> Wish | None:
        wish, self.gamepad.wish = self.gamepad.wish, None
        return wish


@pytest.fixture
def bench(tank: Vehicle) -> Player:
    bench = Player(tank)
    bench.plug()
    return bench


def test_a_stick_counts_while_the_dead_man_is_held(bench):
    assert not bench.move({Y: -1.0})
    assert bench.stick == Stick()
    bench.move({Y: 0.0})
    assert bench.move({LB: 1.0})
    assert bench.stick == Stick(0.0, 0.0, deadman=True)
    assert bench.move({Y: -1.0, X: -0.55})
    assert bench.stick == Stick(1.0, pytest.approx(0.5), deadman=True)
    assert not bench.move({LB: 0.0})
    assert bench.stick == Stick()


def test_holding_still_is_acting_for_as_long_as_the_pad_is_alive(bench):
    bench.move({LB: 1.0, Y: -1.0})
    for _ in range(30):
        assert bench.read()
        assert bench.stick.deadman


def test_a_pad_that_says_nothing_for_long_is_let_go_for_good(bench):
    bench.move({LB: 1.0, Y: -1.0})
    bench.gamepad.silence = 1.0
    assert bench.gamepad.idle_left(bench.now) == 1.0
    assert bench.read(0.9)
    assert not bench.read(0.2)
    assert bench.stick == Stick()
    assert bench.gamepad.idle_left(bench.now) is None
    assert bench.gamepad.words == "Pad has not moved for 1 s; let go of everything, then hold LB anew"
    assert not bench.move({Y: -0.9})  # it is back, and its dead-man was held all the while, for all we know
    assert not bench.move({LB: 0.0, Y: 0.0})
    assert "hold LB to drive" in bench.gamepad.words
    assert bench.move({LB: 1.0})


def test_what_comes_at_the_last_moment_does_not_revive_what_was_silent(bench):
    bench.move({LB: 1.0, Y: -1.0})
    assert not bench.move({Y: -0.9}, after=6.0)


def test_a_stick_asked_for_later_than_it_was_read_is_neutral(bench):
    bench.move({LB: 1.0, Y: -1.0})
    bench.now += 6.0
    assert bench.stick == Stick()


def test_the_robots_own_limit_may_shorten_the_silence(bench, tank):
    assert bench.gamepad.silence == tank.operator_silence


def test_turbo_is_all_the_robot_can_and_enables_by_itself(bench, tank):
    bench.move({Y: -1.0, X: -1.0})
    bench.move({Y: 0.0, X: 0.0})
    bench.move({LB: 1.0, Y: -1.0})
    assert to_twist(bench.stick, bench.gamepad.speeds, tank).linear.x == 0.25
    bench.move({RB: 1.0})
    assert to_twist(bench.stick, bench.gamepad.speeds, tank).linear.x == tank.max_speed
    assert bench.move({LB: 0.0})
    assert bench.stick.deadman
    assert not bench.move({RB: 0.0})


def test_what_a_full_stick_means_is_not_changed_while_turbo_says_so(bench, tank):
    bench.move({RB: 1.0})
    with pytest.raises(ConfigError, match="turbo is held"):
        bench.gamepad.speeds = Speeds(0.1, 0.1)
    bench.move({RB: 0.0})
    bench.gamepad.speeds = Speeds(0.1, 0.1)
    assert bench.gamepad.speeds == Speeds(0.1, 0.1)


def test_what_is_held_when_a_pad_comes_must_be_let_go(tank):
    bench = Player(tank)
    bench.plug(**{LB: 1.0, Y: -1.0})
    assert bench.gamepad.words == "Pad: let go of LB and of the sticks before you drive"
    assert not bench.move({Y: -0.9})
    assert not bench.move({LB: 0.0}, {LB: 1.0})
    assert not bench.move({Y: 0.0})
    assert not bench.move({LB: 0.0})
    assert bench.move({LB: 1.0})


def test_a_pad_that_is_unplugged_is_let_go(bench):
    bench.move({LB: 1.0, Y: -1.0})
    assert not bench.unplug()
    assert bench.stick == Stick()
    assert bench.gamepad.words.startswith("waiting for a gamepad")
    bench.plug("Other", **{LB: 1.0})
    assert not bench.read()
    bench.move({LB: 0.0})
    assert bench.move({LB: 1.0})


def test_a_reset_asks_for_everything_to_be_let_go(bench):
    bench.move({LB: 1.0, Y: -1.0})
    bench.gamepad.reset(bench.now)
    assert bench.stick == Stick()
    assert not bench.move({Y: -0.5})
    bench.move({LB: 0.0})
    assert not bench.move({LB: 1.0})
    bench.move({LB: 0.0, Y: 0.0})
    assert bench.move({LB: 1.0})


def test_a_reset_of_a_pad_at_rest_asks_for_nothing(bench):
    bench.gamepad.reset(bench.now)
    assert bench.move({LB: 1.0})


def test_b_stops_the_robot_and_lets_go(bench):
    bench.move({LB: 1.0, Y: -1.0})
    assert not bench.move({B: 1.0}, {B: 0.0})
    assert bench.wish() is Wish.STOP
    assert bench.stick == Stick()
    bench.read()
    assert bench.wish() is None


def test_a_button_that_is_down_when_a_pad_comes_was_not_pressed(tank):
    bench = Player(tank)
    bench.plug(**{B: 1.0, START: 1.0})
    bench.read(2 * RELEASE_HELD)
    assert bench.wish() is None


def test_start_ends_the_stop_when_it_is_held_alone(bench):
    bench.move({START: 1.0})
    bench.read(RELEASE_HELD - 0.1)
    assert bench.wish() is None
    bench.read(0.2)
    assert bench.wish() is Wish.RELEASE
    bench.read(2 * RELEASE_HELD)
    assert bench.wish() is None  # one press is one wish


@pytest.mark.parametrize("besides", [{LB: 1.0}, {B: 1.0}, {START: 0.0}])
def test_start_does_nothing_with_another_button_or_let_go_early(bench, besides):
    bench.move({START: 1.0})
    bench.move(besides)
    bench.move(dict.fromkeys(besides, 0.0))
    bench.wish()
    bench.read(2 * RELEASE_HELD)
    assert bench.wish() is None


def test_a_button_that_is_down_on_another_pad_does_not_go_on_with_a_release(bench):
    bench.plug()
    bench.move({START: 1.0})
    bench.pads.moved.append(FORGET)  # and in the same look the other one
    bench.plug("Other", **{START: 1.0})
    assert bench.read(RELEASE_HELD) is False
    assert bench.wish() is None


def test_a_release_never_takes_back_a_stop(bench):
    bench.move({START: 1.0})
    bench.gamepad.wish = Wish.STOP
    bench.read(2 * RELEASE_HELD)
    assert bench.wish() is Wish.STOP


def test_another_mapping(tank):
    bench = Player(tank, forward="ABS_X", turn="ABS_Y", deadman="BTN_EAST", stop="-ABS_Z", turbo="")
    bench.plug(ABS_Z=1.0)
    bench.move({B: 1.0})
    bench.move({X: 1.0, Y: -1.0})
    assert bench.stick == Stick(1.0, -1.0, deadman=True)
    bench.move({"ABS_Z": -1.0})
    assert bench.wish() is Wish.STOP


def test_a_pad_without_what_is_needed_never_drives_and_says_what(tank):
    bench = Player(tank, deadman="BTN_PINKIE")
    bench.plug()
    assert bench.gamepad.words == "Pad has no BTN_PINKIE; zteleop gamepad --learn finds out what it has"
    assert not bench.move({RB: 1.0, Y: -1.0})


def test_what_is_wrong_is_said_where_no_pad_may_be_read(tank):
    bench = Player(tank)
    bench.pads.trouble = "not for this user"
    assert bench.gamepad.words == "not for this user"


def test_what_to_do_is_said_of_what_the_pad_has(bench):
    assert bench.gamepad.words == (
        "Pad: hold LB to drive, hold RB for full speed, B stops the robot, Start held ends the stop"
    )
    bench.pads.moved += [FORGET, *(Moved(name, 0.0) for name in (LB, X, Y))]
    bench.read()
    assert bench.gamepad.words == "Pad: hold LB to drive"


def test_entering_and_leaving_is_the_pads(bench):
    with bench.gamepad as gamepad:
        assert bench.pads.entered == 1
        assert gamepad.fileno() == 9
    assert bench.pads.entered == 0


DEEDS = st.one_of(
    st.tuples(st.sampled_from([LB, RB, B, START]), st.sampled_from([0.0, 1.0])),
    st.tuples(st.sampled_from([X, Y]), st.sampled_from([0.0, 0.05]) | st.floats(-1, 1)),
    st.tuples(st.just("reset"), st.none()),
    st.tuples(st.just("wait"), st.floats(0, 6)),
    st.tuples(st.just("plug"), st.dictionaries(st.sampled_from([*REST]), st.sampled_from([-1.0, 0.0, 1.0]))),
)


@given(st.lists(DEEDS, max_size=40))
def test_whatever_is_done_it_drives_only_while_held_and_after_rest(deeds):
    channels = [Channel(name, i, 1000.0, 1500.0, 2000.0, 205, 307, 410, 0) for i, name in enumerate("lr")]
    bench = Player(Vehicle("differential", channels, 0.3, 1.5, 0.0, 0.0, 3.0, 4.08, True, 9.0))
    at, rested, enabled, heard = dict[str, float](), False, False, bench.now
    for what, value in deeds:
        if what == "plug":
            at, rested = {**REST, **value}, False
            bench.plug(**value)
        elif what == "reset":
            bench.gamepad.reset(bench.now)
            rested = False
        elif what == "wait":
            bench.read(value)
        elif at:
            at[what] = value
            bench.move({what: value})
        if enabled and bench.now - heard >= 3.0:
            rested = False
        heard = heard if what in ("reset", "wait") else bench.now
        enabled = bool(at) and (at[LB] > 0.5 or at[RB] > 0.5)
        rested = rested or (bool(at) and not enabled and abs(at[X]) <= 0.1 and abs(at[Y]) <= 0.1)
        stick = bench.stick
        assert -1 <= stick.forward <= 1
        assert -1 <= stick.turn <= 1
        assert not stick.deadman or (enabled and rested)
        assert stick.deadman or stick == Stick()
