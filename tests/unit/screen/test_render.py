import re

import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.screen.boards import dashboard

from zteleop.control.stick import Speeds
from zteleop.messages import Channel, DriveStatus, Odometry, Pulse, Pwm, Stop, Twist, Vehicle
from zteleop.screen.dashboard import Task
from zteleop.screen.render import Dashboard, render, steering_angle
from zteleop.screen.view import View
from zteleop.terminal.cells import width


def shown(board: Dashboard, columns: int = 80, rows: int = 24) -> list[str]:
    return render(board, columns, rows, unicode=True, color=False)


def board(car: Vehicle, drive: str = "step", why: str = "obeying keyboard", **more: object) -> Dashboard:
    pulses = [Pulse("steering", 1, 0.0, 1500.0, 375), Pulse("throttle", 0, 0.0, 1500.0, 370)]
    rest = Twist.zero()
    status = DriveStatus(
        "driving", why, "keyboard", "3fa2", rest, rest, pulses, 1, 0.0, [], "", "", 0, 0, 3.0, 0.06, "", 0
    )
    seen = {"command": Pwm(375, 370), "ours": True, "status": status, "odom": Odometry.zero()} | more
    return dashboard(drive, car, robot="archangel", **seen)


@pytest.mark.parametrize("why", ["", "obeying keyboard", "a long reason " * 30])
def test_the_output_line_is_where_the_donkeycar_nodes_had_it(car, why):
    line = shown(board(car, why=why))[3]
    assert line == "Currently outputting:[Steering PWM, Throttle PWM] = [375, 370]"
    assert line.index("[375, 370]") == 52


def test_the_picture_stands_at_the_right_of_a_wide_screen(car):
    lines = shown(board(car))
    assert any("⣿" in line[46:] for line in lines)
    assert not any("⣿" in line[:46] for line in lines)
    assert any("┤ 1 m" in line for line in lines)


def test_it_stands_below_on_a_narrow_and_high_one_and_nowhere_on_a_small_one(car):
    high = shown(board(car), 40, 40)
    assert min(row for row, line in enumerate(high) if "⣿" in line) > next(
        row for row, line in enumerate(high) if line.startswith("place")
    )
    assert not any("⣿" in line for line in shown(board(car), 40, 14))


def test_the_keys_and_the_note_are_at_the_bottom(car):
    lines = shown(board(car, note="connected to archangel"))
    assert len(lines) == 24
    assert lines[-2] == "backspace STOP   arrows drive   space throttle off   x neutral   q quit   ? keys"
    assert lines[-1] == "connected to archangel"


@pytest.mark.parametrize("columns", [80, 40, 24, 16])
@pytest.mark.parametrize("drive", ["step", "hold"])
def test_the_stop_key_comes_first_and_the_release_key_only_while_stopped(car, columns, drive):
    page = board(car, drive)
    text = " ".join(shown(page, columns, 40))
    assert "backspace STOP" in text
    assert "r release" not in text
    page.seen.status.stops = [Stop.zero()]
    lines = [line for line in shown(page, columns, 40) if "backspace STOP" in line or "r release" in line]
    assert " ".join(lines).split()[:4] == ["backspace", "STOP", "r", "release"]


def test_stopped_is_said_in_red_with_its_reason_and_the_stop_key_is_bold(car):
    page = board(car, why="stopped by ann@desk: a cat")
    page.seen.status.state = "stopped"
    for columns in (80, 40):
        lines = render(page, columns, 24, unicode=True, color=True)
        assert any(line.startswith("\x1b[1;97;41m") and "● stopped" in line for line in lines[:2])
        assert "stopped by ann@desk: a cat" in lines
        assert any("\x1b[1mbackspace\x1b[0m\x1b[1m STOP\x1b[0m" in line for line in lines)
    assert shown(page)[3] == "Currently outputting:[Steering PWM, Throttle PWM] = [375, 370]"


def test_the_page_of_keys_has_no_picture_behind_it(car):
    lines = shown(board(car)._replace(keys=[("q", "quit")]))
    assert "q   quit" in lines
    assert not any("⣿" in line for line in lines)


@pytest.mark.parametrize(("columns", "rows"), [(80, 24), (40, 8), (20, 5), (20, 3)])
def test_the_stop_key_stays_beside_the_page_of_keys_in_any_window(car, columns, rows):
    page = board(car)._replace(keys=[(f"f{number}", f"does {number}") for number in range(12)])
    assert any("backspace STOP" in line for line in shown(page, columns, rows))


@pytest.mark.parametrize("rows", [24, 12, 8])
def test_a_page_of_keys_that_does_not_fit_says_how_much_more_there_is(car, rows):
    page = board(car)._replace(keys=[(f"f{number}", f"does {number}") for number in range(12)])
    lines = shown(page, columns=40, rows=rows)
    missing = 12 - sum("does" in line for line in lines)
    said = [int(line.split()[1]) for line in lines if "more: make the window larger" in line]
    assert bool(said) is bool(missing) is (rows < 24)
    assert all(more == missing for more in said)


ALARM = (
    "archangel has not acknowledged the stop within 2 s: "
    "cut its power, or run zteleop neutral --robot archangel on it"
)


@pytest.mark.parametrize(("columns", "rows"), [(80, 24), (40, 12), (30, 6), (120, 40)])
def test_an_alarm_is_whole_and_red_in_any_window(car, columns, rows):
    page = board(car, note=ALARM, alarm=True)
    assert ALARM in " ".join(shown(page, columns, rows))
    reds = [line for line in render(page, columns, rows, unicode=True, color=True) if "\x1b[1;97;41m" in line]
    assert ALARM in " ".join(re.sub(r"\x1b\[[\d;]+m", "", line) for line in reds)


def test_on_a_single_line_an_alarm_stands_before_what_is_driven(car):
    assert shown(board(car, note=ALARM, alarm=True), 40, 1) == [f"● driving  {ALARM}"[:39] + "…"]


def test_a_small_window_keeps_what_matters_most(car):
    lines = shown(board(car), 20, 3)
    assert lines == ["● driving", "obeying keyboard", "out      [375, 370]"]
    assert shown(board(car), 40, 1) == ["● driving  [375, 370]"]


def test_text_from_the_bus_cannot_write_on_the_screen(car):
    nasty = "\x1b[2J\x1b[H\x9b31m\u202e\r\n\x07 evil"
    for columns in (80, 30):
        page = board(car, why=nasty, note=nasty)._replace(robot=nasty)
        page.seen.status.source = page.seen.status.operator = page.seen.status.pulses[0].name = nasty
        for line in render(page, columns, 24, unicode=True, color=True):
            assert re.sub(r"\x1b\[[\d;]+m", "", line).isprintable()


def test_colour_only_on_request(car):
    assert "\x1b[32m● driving\x1b[0m" in render(board(car), 80, 24, unicode=True, color=True)[0]
    assert "\x1b" not in "".join(shown(board(car)))


def test_without_unicode_all_is_ascii(car):
    assert "".join(render(board(car, why="Zürich"), 100, 30, unicode=False, color=True)).isascii()


@pytest.mark.parametrize(("columns", "rows"), [(80, 24), (80, 6), (62, 5), (40, 12), (30, 7), (20, 8)])
@pytest.mark.parametrize("drive", ["step", "hold"])
def test_a_cap_takes_the_stop_key_from_no_window(car, columns, rows, drive):
    page = board(car, drive)
    before = " ".join(shown(page, columns, rows))
    page.seen.status.max_speed, page.seen.status.slowed = 1.5, "the Pi's supply is too low (undervoltage)"
    after = " ".join(shown(page, columns, rows))
    assert ("backspace STOP" in after) == ("backspace STOP" in before)
    assert "backspace STOP" in after or rows < 7


def test_a_cap_is_shown_in_a_common_window(car):
    page = board(car)
    page.seen.status.max_speed, page.seen.status.slowed = 1.5, "the Pi's supply is too low (undervoltage)"
    assert "at most 1.50 m/s: the Pi's supply is too low (undervoltage)" in shown(page)


WORDS = st.text(max_size=60)
ANY = st.floats()


@st.composite
def boards(draw) -> Dashboard:
    ticks = st.integers(-(2**15), 2**15 - 1)
    channels = [
        Channel(name, 0, 1.0, 2.0, 3.0, *(draw(ticks) for _ in range(4)))
        for name in draw(st.sampled_from([(), ("steering", "throttle"), ("left", "right")]))
    ]
    kind = draw(st.sampled_from(["ackermann", "differential"]))
    vehicle = draw(
        st.sampled_from(
            [
                None,
                Vehicle(kind, channels, draw(ANY), draw(ANY), 0.2, draw(st.floats(0, 1)), 5.0, 4.08, True, 9),
            ]
        )
    )
    pulses = [Pulse(draw(st.one_of(st.just("steering"), WORDS)), 0, draw(ANY), 1.0, draw(ticks))]
    twist = Twist.planar(draw(ANY), draw(ANY))
    state = draw(st.sampled_from(["idle", "stopped"]))
    words = [draw(WORDS) for _ in range(3)]
    cap = draw(ANY), draw(ANY), draw(WORDS)
    status = DriveStatus(state, *words, twist, twist, pulses, 0, 0.0, [], "", "", 0, 0, *cap, 0)
    odom = Odometry.zero()
    odom.pose.pose.position.x, odom.pose.pose.orientation.z = draw(ANY), draw(ANY)
    seen = View(
        vehicle=vehicle,
        command=draw(st.sampled_from([None, twist, Pwm(draw(ticks), draw(ticks))])),
        status=draw(st.sampled_from([None, status])),
        ours=draw(st.booleans()),
        odom=draw(st.sampled_from([None, odom])),
        note=draw(WORDS),
        alarm=draw(st.booleans()),
    )
    return Dashboard(
        draw(WORDS),
        draw(st.sampled_from(["step", "hold"])),
        Speeds(draw(st.floats(0, 100)), 1.0),
        seen,
        trail=draw(st.lists(st.tuples(ANY, ANY), max_size=3)),
        idle_left=draw(st.sampled_from([None, 0.0, 3.2])),
    )


@given(boards(), st.integers(1, 130), st.integers(1, 50), st.booleans(), st.booleans())
def test_whatever_is_shown_fits(page, columns, rows, unicode, color):
    lines = render(page, columns, rows, unicode=unicode, color=color)
    assert len(lines) <= rows
    plain = [re.sub(r"\x1b\[[\d;]+m", "", line) for line in lines]
    assert all(width(line) <= columns for line in plain)
    assert all(line.isprintable() for line in plain)
    assert unicode or all(line.isascii() for line in plain)


def test_a_terminal_shows_exactly_these_lines(car):
    screen = pyte.Screen(80, 24)
    pyte.Stream(screen).feed("\r\n".join(render(board(car), 80, 24, unicode=True, color=True)))
    assert [line.rstrip() for line in screen.display] == shown(board(car))


@pytest.mark.parametrize(("fraction", "angle"), [(0.5, 0.2), (-1.0, -0.4), (7.0, 0.4), (float("nan"), 0.0)])
def test_the_wheels_point_where_the_pulse_says(car, fraction, angle):
    page = board(car)
    page.seen.status.pulses = [
        Pulse("throttle", 0, 0.9, 1500.0, 370),
        Pulse("steering", 1, fraction, 1500.0, 375),
    ]
    assert steering_angle(page) == pytest.approx(angle)


def test_what_was_said_last_is_not_shown_as_what_is_so_once_nobody_says_so(car):
    page = board(car)
    seen = page.seen._replace(silence=0.6, status=page.seen.status)
    page.seen.status.state = "driving"
    lines = shown(page._replace(seen=seen))
    assert "no word for 0.6 s" in lines[0]
    assert "operate" not in lines[0]
    assert "has said nothing for 0.6 s; the last was: driving" in lines[1]
    told = {line.split()[0]: line[10:40].strip() for line in lines if line.strip()}
    assert (told["out"], told["allowed"]) == ("-", "-")
    assert not any("[375, 370]" in line and "outputting" in line for line in lines)


TASK = [
    ("3 of 7", "left and right turn the steering. Press enter when the wheels point straight ahead."),
    ("", "k keeps"),
]


@pytest.mark.parametrize(("columns", "rows"), [(100, 30), (80, 24), (60, 20), (40, 12)])
def test_a_task_stands_above_the_values_in_whole_words_and_nothing_pictures_what_nobody_knows(
    car, columns, rows
):
    lines = shown(board(car)._replace(task=Task(TASK, unmeasured=True)), columns, rows)
    text = " ".join(" ".join(lines).split())
    assert (
        "3 of 7: left and right turn the steering. Press enter when the wheels point straight ahead." in text
    )
    first, asked = (
        next((row for row, line in enumerate(lines) if line.startswith(word)), rows)
        for word in ("3 of 7", "steering")
    )
    assert first < asked
    assert not any("⣿" in line or line.startswith("allowed") for line in lines)
