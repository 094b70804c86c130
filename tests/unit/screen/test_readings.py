import pytest
from unit.screen.boards import dashboard, pulses, status, text, texts

from zteleop.messages import Pwm, Twist
from zteleop.screen.footer import footer
from zteleop.screen.readings import brief, readings


def test_a_car_steers_by_curvature_so_turning_speed_is_not_shown(car):
    board = dashboard("hold", car)
    assert not any("i/k" in line for line in texts([*readings(board, 80, True), *footer(board, 80, True)]))


def test_the_countdown_turns_yellow(car):
    for left, style in ((3.2, ""), (1.9, "yellow")):
        lines = readings(dashboard("step", car, idle_left=left, status=status()), 80, True)
        assert [li.spans[1].style for li in lines if f"neutral in {left} s" in text(li.spans)] == [style]


def test_nothing_counts_down_where_no_robot_is_heard(car):
    shown = texts(readings(dashboard("step", car, idle_left=3.2), 80, True))
    assert "idle      nobody hears what is asked" in shown
    assert not any("neutral in" in line for line in shown)


def test_nothing_counts_down_where_the_link_was_lost(car):
    lost = status()
    lost.state = "link lost"
    shown = texts(readings(dashboard("step", car, idle_left=3.2, status=lost), 80, True))
    assert "idle      at rest: the link was lost" in shown


def test_nothing_counts_down_for_whoever_is_not_obeyed(car):
    held = {
        "idle_left": 3.2,
        "status": status(),
        "command": Twist.planar(0.3),
        "refused": "another drives",
    }
    for ours, words in ((False, "not yours to end: you are not obeyed"), (True, "neutral in 3.2 s")):
        shown = texts(readings(dashboard("step", car, ours=ours, **held), 80, True))
        assert f"idle      {words}" in shown


def test_a_place_that_is_told_no_more_is_said_to_be(car):
    for lost in (True, False):
        shown = texts(readings(dashboard("step", car, status=status(), odom_lost=lost), 80, True))
        assert any("its place is not told any more" in line for line in shown) == lost


def test_on_a_single_line_what_is_asked_shows_only_while_nobody_obeys(car):
    said = status(pulses=pulses(car, {"throttle": 371}))
    asked = "asked [375, 380], not obeyed  "
    for ours, shown in ((True, "● driving  [375, 371]  "), (False, f"● driving  [375, 371]  {asked}")):
        board = dashboard("step", car, command=Pwm(375, 380), status=said, ours=ours)
        assert text(brief(board, True)) == shown
    board = dashboard("hold", car, command=Twist.planar(0.3), status=said, ours=True)
    assert text(brief(board, True)) == "● driving  +0.25 +0.40  "


@pytest.mark.parametrize("columns", [80, 30])
def test_all_keys_stand_where_values_and_picture_did(car, columns):
    keys = [("up w", "forward, a step each press"), ("?", "show these keys, or hide them")]
    shown = texts(readings(dashboard("step", car, status=status())._replace(keys=keys), columns, True))
    assert [line.split() for line in shown[-2:]] == [f"{key} {does}".split() for key, does in keys]
    assert not any("allowed" in line for line in shown)
