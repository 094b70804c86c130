import pytest

from zteleop.control.stick import Speeds
from zteleop.inputs.dashboard import Dashboard, bar, footer, readings, steering_angle
from zteleop.messages import DriveStatus, Pulse, Pwm, Twist


def texts(lines) -> list[str]:
    return ["".join(span.text for span in line.spans) for line in lines]


def status(**changes) -> DriveStatus:
    fields = {
        **{"state": "driving", "why": "obeying keyboard", "source": "keyboard", "operator": "3fa2b1c0"},
        **{"wanted": Twist.planar(0.3, 0.5), "applied": Twist.planar(0.25, 0.4)},
        **{"pulses": [], "seq": 1, "written": 0.0, "refused": 0, "clamped": 0},
    }
    return DriveStatus(**fields | changes)


def test_the_bar_grows_a_mark_a_step_and_is_as_wide_as_the_most():
    assert bar(3, 6, 6, "<>") == "[      O>>>   ]"
    assert bar(-2, 6, 6, "<>") == "[    <<O      ]"
    assert bar(0, 6, 6, "<>") == "[      O      ]"
    assert bar(6, 6, 6, "<>") == "[      O>>>>>>]"


def test_more_steps_than_cells_share_them_and_the_first_shows():
    assert bar(1, 30, 8, "-+") == "[        O+       ]"
    assert bar(-30, 30, 8, "-+") == "[--------O        ]"


@pytest.mark.parametrize(
    ("steering", "throttle", "lines"),
    [
        (375, 370, ("steering  [      O      ]  straight", "throttle  [        O        ]  neutral")),
        (330, 372, ("steering  [      O>>>   ]  right 3/6", "throttle  [        O+       ]  forward 2/30")),
        (460, 355, ("steering  [<<<<<<O      ]  left 6/6", "throttle  [    ----O        ]  reverse 15/15")),
    ],
)
def test_the_levers_are_bars(car, steering, throttle, lines):
    shown = texts(readings(Dashboard("car", "step", Speeds(), car, pwm=Pwm(steering, throttle)), 80, True))
    assert tuple(shown[5:7]) == lines


def test_right_is_right_whichever_number_is_larger(car):
    channel = car.channels[0]
    channel.min_ticks, channel.max_ticks = channel.max_ticks, channel.min_ticks
    shown = texts(readings(Dashboard("car", "step", Speeds(), car, pwm=Pwm(390, 370)), 80, True))
    assert shown[5] == "steering  [      O>     ]  right 1/6"


@pytest.mark.parametrize(
    ("changes", "ours", "words"),
    [
        ({}, True, "● driving, you operate"),
        ({}, False, "● driving, keyboard 3fa2 operates"),
        ({"state": "idle", "operator": "", "source": ""}, False, "● idle, nobody operates"),
        ({"state": "link lost"}, True, "● link lost, you operate"),
    ],
)
def test_it_says_who_operates(car, changes, ours, words):
    shown = texts(
        readings(Dashboard("car", "step", Speeds(), car, status=status(**changes), ours=ours), 80, True)
    )
    assert shown[0].endswith(words)
    assert shown[0].startswith("car  step drive")


@pytest.mark.parametrize(
    ("state", "style"),
    [("driving", "green"), ("idle", "yellow"), ("link lost", "yellow"), ("stopped", "red"), ("fault", "red")],
)
def test_the_state_has_its_colour(car, state, style):
    top = readings(Dashboard("car", "step", Speeds(), car, status=status(state=state)), 80, True)[0]
    assert [span.style for span in top.spans if state in span.text] == [style]


def test_without_an_actuator_it_says_what_to_do():
    shown = texts(readings(Dashboard("archangel", "step", Speeds()), 80, True))
    assert shown[1] == "nobody moves: no actuator heard on robot archangel; start `zteleop actuator`"
    assert shown[3].endswith("[-, -]")


def test_hold_shows_wanted_and_applied_and_what_the_speed_keys_change(tank):
    board = Dashboard("t", "hold", Speeds(0.2, 1.0), tank, twist=Twist.planar(0.3, -0.5), status=status())
    shown = texts(readings(board, 80, True))
    assert shown[4].split() == ["wanted", "+0.30", "m/s", "-0.50", "rad/s"]
    assert shown[5].split() == ["applied", "+0.25", "m/s", "+0.40", "rad/s"]
    assert shown[6].split() == ["full", "stick", "0.20", "m/s", "u/j", "1.00", "rad/s", "i/k"]
    assert "i/k turning" in " ".join(texts(footer(board, 80, True)))


def test_a_car_steers_by_curvature_so_turning_speed_is_not_shown(car):
    board = Dashboard("c", "hold", Speeds(), car)
    assert not any("i/k" in text for text in texts([*readings(board, 80, True), *footer(board, 80, True)]))


def test_the_countdown_turns_yellow(car):
    for left, style in ((3.2, ""), (1.9, "yellow")):
        lines = readings(Dashboard("c", "step", Speeds(), car, idle_left=left), 80, True)
        assert [li.spans[0].style for li in lines if f"neutral in {left} s" in li.spans[0].text] == [style]


@pytest.mark.parametrize(("fraction", "angle"), [(0.5, 0.2), (-1.0, -0.4), (7.0, 0.4), (float("nan"), 0.0)])
def test_the_wheels_point_where_the_pulse_says(car, fraction, angle):
    pulses = [Pulse("throttle", 0, 0.9, 1500.0, 370), Pulse("steering", 1, fraction, 1500.0, 375)]
    board = Dashboard("c", "step", Speeds(), car, status=status(pulses=pulses))
    assert steering_angle(board) == pytest.approx(angle)
    assert "throttle 370, steering 375" in " ".join(texts(readings(board, 80, True)))
