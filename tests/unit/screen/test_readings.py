import pytest
from unit.screen.boards import dashboard

from zteleop.messages import DriveStatus, Pulse, Twist
from zteleop.screen.readings import footer, readings, steering_angle


def texts(lines) -> list[str]:
    return ["".join(span.text for span in line.spans) for line in lines]


def status(**changes) -> DriveStatus:
    fields = {
        **{"state": "driving", "why": "obeying keyboard", "source": "keyboard", "operator": "3fa2b1c0"},
        **{"wanted": Twist.planar(0.3, 0.5), "applied": Twist.planar(0.25, 0.4)},
        **{"pulses": [], "seq": 1, "written": 0.0, "stops": [], "unkept": "", "confirmed": ""},
        **{"refused": 0, "clamped": 0},
        **{"max_speed": 3.0, "latency": 0.06, "slowed": "", "released": 0},
    }
    return DriveStatus(**fields | changes)


@pytest.mark.parametrize(
    ("changes", "ours", "words"),
    [
        ({}, True, "● driving, you operate"),
        ({}, False, "● driving, keyboard b1c0 operates"),
        ({"state": "idle", "operator": "", "source": ""}, False, "● idle, nobody operates"),
        ({"state": "link lost"}, True, "● link lost, you operate"),
    ],
)
def test_it_says_who_operates(car, changes, ours, words):
    shown = texts(readings(dashboard("step", car, status=status(**changes), ours=ours), 80, True))
    assert shown[0].endswith(words)
    assert shown[0].startswith("car  step drive")


@pytest.mark.parametrize(
    ("state", "style"),
    [("driving", "green"), ("idle", "yellow"), ("link lost", "yellow"), ("stopped", "red"), ("fault", "red")],
)
def test_the_state_has_its_colour(car, state, style):
    top = readings(dashboard("step", car, status=status(state=state)), 80, True)[0]
    assert [span.style for span in top.spans if state in span.text] == [style]


def test_without_an_actuator_it_says_what_to_do():
    shown = texts(readings(dashboard("step", robot="archangel"), 80, True))
    words = (
        "no actuator heard on robot archangel; start `zteleop actuator --robot archangel`, or, if it moves"
    )
    assert words in f"{shown[1]} {shown[2]}"
    assert shown[3].endswith("[-, -]")


def test_a_car_steers_by_curvature_so_turning_speed_is_not_shown(car):
    board = dashboard("hold", car)
    assert not any("i/k" in text for text in texts([*readings(board, 80, True), *footer(board, 80, True)]))


def test_the_countdown_turns_yellow(car):
    for left, style in ((3.2, ""), (1.9, "yellow")):
        lines = readings(dashboard("step", car, idle_left=left), 80, True)
        assert [li.spans[0].style for li in lines if f"neutral in {left} s" in li.spans[0].text] == [style]


@pytest.mark.parametrize(("fraction", "angle"), [(0.5, 0.2), (-1.0, -0.4), (7.0, 0.4), (float("nan"), 0.0)])
def test_the_wheels_point_where_the_pulse_says(car, fraction, angle):
    pulses = [Pulse("throttle", 0, 0.9, 1500.0, 370), Pulse("steering", 1, fraction, 1500.0, 375)]
    board = dashboard("step", car, status=status(pulses=pulses))
    assert steering_angle(board) == pytest.approx(angle)
    assert "throttle 370, steering 375" in " ".join(texts(readings(board, 80, True)))


LATE = {"max_speed": 2.25, "slowed": "commands of keyboard are up to 300 ms old"}


@pytest.mark.parametrize(("columns", "words"), [(80, 80), (62, 62), (40, 40), (20, 20)])
def test_a_cap_that_bites_is_one_line_and_one_that_does_not_is_none(car, columns, words):
    capped = "at most 2.25 m/s: commands of keyboard are up to 300 ms old"[:words]
    for changes, lines in ((LATE, [capped]), ({}, [])):
        board = dashboard("step", car, status=status(**changes))
        assert [text for text in texts(readings(board, columns, True)) if "at most" in text] == lines


def test_on_a_wide_screen_a_cap_moves_nothing_and_yields_to_a_long_reason(car):
    board = dashboard("step", car, status=status(**LATE))
    shown = texts(readings(board, 80, True))
    assert shown[1:3] == ["obeying keyboard", "at most 2.25 m/s: commands of keyboard are up to 300 ms old"]
    assert shown[3].startswith("Currently outputting")
    why = "a long reason to stand still " * 4
    shown = texts(readings(dashboard("step", car, status=status(why=why, **LATE)), 80, True))
    assert "at most" not in " ".join(shown)
    assert shown[3].startswith("Currently outputting")
