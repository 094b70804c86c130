import pytest
from unit.screen.boards import dashboard, pulses, status, texts

from zteleop.control.gate import Refusal
from zteleop.control.stop import stopped_by
from zteleop.messages import Pwm, Stop, Twist
from zteleop.screen.dashboard import Task
from zteleop.screen.heading import heading
from zteleop.screen.readings import readings
from zteleop.screen.view import Unmanned


@pytest.mark.parametrize(
    ("changes", "ours", "words"),
    [
        ({}, True, "● driving, you operate as keyboard b1c0"),
        ({}, False, "● driving, keyboard b1c0 operates"),
        ({"state": "idle", "operator": "", "source": ""}, False, "● idle, nobody operates"),
        ({"state": "link lost"}, True, "● link lost, you operate as keyboard b1c0"),
    ],
)
def test_it_says_who_operates(car, changes, ours, words):
    shown = texts(heading(dashboard("step", car, status=status(**changes), ours=ours), 80, True))
    assert shown[0].endswith(words)
    assert shown[0].startswith("car  step drive")


@pytest.mark.parametrize(
    ("state", "style"), [("driving", "green"), ("idle", "yellow"), ("link lost", "yellow")]
)
def test_the_state_has_its_colour(car, state, style):
    top = heading(dashboard("step", car, status=status(state=state)), 80, True)[0]
    assert [span.style for span in top.spans if state in span.text] == [style]


@pytest.mark.parametrize("state", ["stopped", "fault"])
def test_a_stop_is_a_bar_from_side_to_side(car, state):
    for columns in (80, 30):
        top = heading(dashboard("step", car, status=status(state=state)), columns, True)[0]
        assert [(span.style, len(span.text)) for span in top.spans] == [("alarm", columns)]
        assert f"● {state}" in top.spans[0].text


def test_without_an_actuator_it_says_what_to_do():
    shown = texts(heading(dashboard("step", robot="archangel"), 80, True))
    words = (
        "no actuator heard on robot archangel; start `zteleop actuator --robot archangel`, or, if it moves"
    )
    assert words in f"{shown[1]} {shown[2]}"


def test_a_robot_that_was_this_tasks_own_is_not_to_be_started_by_anybody():
    gone = dashboard("step", robot="demo")._replace(task=Task([("demo", "its robot ended")], ends=True))
    assert " ".join(texts(heading(gone, 80, True))[1:]).strip() == "robot demo is gone"


def test_without_an_actuator_it_says_which_robots_could_have_been_meant():
    board = dashboard("step", robot="archangle")._replace(others="heard here: archangel")
    shown = " ".join(texts(heading(board, 80, True))[1:])
    assert (
        "no actuator heard on robot archangle (heard here: archangel); q, and --robot NAME drives one of "
        "those; or start `zteleop actuator" in shown
    )


def test_before_a_robot_can_have_been_heard_it_says_that_it_listens():
    board = dashboard("step", robot="archangel")._replace(others=None)
    shown = texts(heading(board, 80, True))
    assert shown[0].endswith("● looking")
    assert shown[1] == "listening for robot archangel"


HELD = Refusal.HELD.value


@pytest.mark.parametrize("columns", [80, 40, 62])
def test_who_is_refused_is_told_the_whole_reason(car, columns):
    board = dashboard("hold", car, command=Twist.planar(0.2), status=status(), refused=HELD)
    lines = heading(board, columns, True)
    assert f"you are not obeyed: {HELD}" in " ".join(texts(lines))
    assert {line.spans[0].style for line in lines if "obeyed" in texts([line])[0]} == {"yellow"}


def test_a_robot_without_an_actuator_is_told_as_its_watchdog_does(car):
    lines = texts(
        heading(dashboard("hold", car, unmanned=Unmanned("restarting", "it ended; wait")), 80, True)
    )
    assert lines[0].endswith("● restarting")
    assert lines[1] == "it ended; wait"


def test_in_steps_where_nothing_is_held_the_key_is_named_that_lets_go(car):
    board = dashboard("step", car, command=Pwm(405, 370), status=status(), refused=HELD)
    told = " ".join(texts(heading(board, 80, True)))
    assert "drives this source; press x for neutral, and begin anew when that one is done" in told
    told = " ".join(texts(heading(board._replace(bound={}), 80, True)))
    assert "let go, and begin anew" in told


def test_nobody_is_told_of_a_refusal_whom_the_robot_obeys_by_now(car):
    board = dashboard("step", car, command=Pwm(405, 370), status=status(), refused=HELD, ours=True)
    assert "obeyed" not in " ".join(texts(heading(board, 80, True)))


def test_nobody_is_told_of_a_refusal_who_asks_for_nothing(car):
    assert "obeyed" not in " ".join(
        texts(heading(dashboard("step", car, status=status(), refused=HELD), 80, True))
    )


def test_while_stopped_the_first_reason_is_the_stop(car):
    said = status(state="stopped", why="stopped by ann@desk: a cat", operator="")
    refused = "the robot is kept at rest (stopped by ann@desk: a cat)"
    board = dashboard("step", car, command=Pwm(405, 370), status=said, refused=refused)
    assert texts(heading(board, 80, True))[1:] == [
        "stopped by ann@desk: a cat",
        "you are not obeyed: the robot is kept at rest",
    ]


@pytest.mark.parametrize(
    ("ticks", "ours", "told"),
    [(370, True, False), (372, True, True), (373, True, True), (374, True, False), (372, False, False)],
)
def test_a_throttle_in_the_dead_zone_says_that_nothing_turns(car, ticks, ours, told):
    car.channels[1].dead_ticks = 3
    said = status(pulses=pulses(car, {"throttle": ticks}))
    board = dashboard("step", car, command=Pwm(375, ticks), status=said, ours=ours)
    words = f"throttle {ticks} is in the motor's dead zone, 367 to 373: it does not turn yet"
    assert (words in texts(heading(board, 80, True))) == told


def test_in_the_dead_zone_what_bounds_the_speed_is_named(car):
    car.channels[1].dead_ticks = 3
    said = status(pulses=pulses(car, {"throttle": 372}), max_speed=0.06, slowed="limits.turn is 0.1 rad/s")
    shown = texts(heading(dashboard("step", car, command=Pwm(375, 372), status=said, ours=True), 100, True))
    assert "throttle 372 is in the motor's dead zone, 367 to 373, as limits.turn is 0.1 rad/s" in shown


def test_one_that_ended_is_not_also_said_to_be_silent(car):
    board = dashboard("hold", car, unmanned=Unmanned("ended", "at rest"), silence=1.2)
    assert "no word" not in " ".join(texts(heading(board, 80, True)))


LATE = {"max_speed": 2.25, "slowed": "commands of keyboard are up to 300 ms old"}


@pytest.mark.parametrize(("columns", "words"), [(80, 80), (62, 62), (40, 40), (20, 20)])
def test_a_cap_that_bites_is_one_line_and_one_that_does_not_is_none(car, columns, words):
    capped = "at most 2.25 m/s: commands of keyboard are up to 300 ms old"[:words]
    for changes, lines in ((LATE, [capped]), ({}, [])):
        board = dashboard("step", car, status=status(**changes))
        assert [text for text in texts(heading(board, columns, True)) if "at most" in text] == lines


def test_on_a_wide_screen_a_cap_moves_nothing_and_yields_to_a_long_reason(car):
    board = dashboard("step", car, status=status(**LATE))
    shown = texts(readings(board, 80, True))
    capped = "at most 2.25 m/s: commands of keyboard are up to 300 ms old"
    assert shown[1:3] == ["keyboard b1c0 drives", capped]
    assert shown[3].startswith("Currently outputting")
    why = "a long reason to stand still " * 4
    shown = texts(readings(dashboard("step", car, status=status(why=why, **LATE)), 80, True))
    assert "at most" not in " ".join(shown)
    assert shown[3].startswith("Currently outputting")


def test_a_screen_names_the_key_that_releases_a_stop(car):
    why = stopped_by([Stop(True, 7, "ann@desk", "a cat")])
    board = dashboard("step", car, status=status(state="stopped", why=why))
    words = "stopped by ann@desk: a cat; r releases it, then begin from neutral"
    assert texts(heading(board, 80, True))[1] == words


def test_a_key_that_counts_as_held_since_before_is_told_what_to_do(car):
    board = dashboard("step", car, status=status(state="idle", why="nobody drives"))
    shown = texts(heading(board._replace(in_vain="x does nothing here"), 80, True))
    assert "x does nothing here" in shown
