import pytest
from unit.screen.boards import dashboard, pulses, status, text, texts

from zteleop.control.stick import Speeds
from zteleop.inputs.keymap import KEYMAPS, first_keys
from zteleop.messages import Odometry, Pwm, Twist
from zteleop.screen.values import asked_line, output_line, speeds_line, value_lines


def words(lines) -> list[list[str]]:
    return [line.split() for line in texts(lines)]


def test_asked_allowed_and_put_out_have_a_line_each(car):
    said = status(pulses=pulses(car, {"throttle": 380, "steering": 405}))
    odom = Odometry.zero()
    odom.twist.twist = Twist.planar(0.2, 0.3)
    board = dashboard("hold", car, command=Twist.planar(0.3, -0.5), status=said, ours=True, odom=odom)
    assert words(value_lines(board, 80, True)) == [
        ["asked", "+0.30", "m/s", "-0.50", "rad/s"],
        ["allowed", "+0.25", "m/s", "+0.40", "rad/s"],
        ["out", "steering", "405,", "throttle", "380"],
        ["moving", "+0.20", "m/s", "+0.30", "rad/s"],
        ["place", "x", "0.00", "y", "0.00", "m", "0°"],
    ]


def test_a_narrow_window_has_the_numbers_alone(car):
    said = status(pulses=pulses(car, {"throttle": 380, "steering": 405}))
    board = dashboard("hold", car, command=Twist.planar(0.3, -0.5), status=said, ours=True)
    assert texts(value_lines(board, 20, True)) == [
        "asked    +0.30 -0.50",
        "allowed  +0.25 +0.40",
        "out      405 380",
    ]


def test_the_line_of_the_donkeycar_nodes_says_what_the_chip_took_not_what_is_asked(car):
    said = status(state="stopped", pulses=pulses(car, {}))
    board = dashboard("step", car, command=Pwm(375, 371), status=said)
    assert text(output_line(board).spans).endswith("= [375, 370]")
    assert text(asked_line(board, 80).spans) == "asked     [375, 371]  not obeyed"


def test_nothing_is_put_out_without_an_actuator_or_a_pulse(car):
    for said, words in ((None, "-"), (status(confirmed="cut"), "no pulse: its outputs are cut")):
        if said:
            said.pulses = pulses(car, {"throttle": 380})
        board = dashboard("step", car, command=Pwm(375, 371), status=said)
        assert text(output_line(board).spans).endswith("= [-, -]")
        assert texts(value_lines(board, 80, True))[2] == f"out       {words}"


@pytest.mark.parametrize(
    ("state", "ours", "obeyed"),
    [("driving", True, True), ("driving", False, False), ("stopped", True, False), ("idle", True, False)],
)
def test_what_is_not_obeyed_is_dim_and_says_so(car, state, ours, obeyed):
    for drive, command in (("step", Pwm(405, 370)), ("hold", Twist.planar(0.3))):
        board = dashboard(drive, car, command=command, status=status(state=state), ours=ours)
        line = asked_line(board, 44)
        assert (line.spans[1].style, "not obeyed" in text(line.spans)) == (
            "" if obeyed else "dim",
            not obeyed,
        )
        assert len(text(line.spans)) <= 44


@pytest.mark.parametrize(("drive", "words"), [("step", "[375, 370]"), ("hold", "+0.00 m/s  +0.00 rad/s")])
def test_who_asks_for_nothing_asks_for_rest(car, drive, words):
    line = asked_line(dashboard(drive, car, status=status()), 80)
    assert (text(line.spans), line.spans[1].style) == (f"asked     {words}", "dim")


def test_what_a_full_stick_means(car, tank):
    for vehicle, columns, words in (
        (tank, 80, "full      0.20 m/s u/j  1.00 rad/s i/k"),
        (car, 80, "full      0.20 m/s u/j  full lock"),
        (tank, 20, "speeds    0.20  1.00"),
        (car, 20, "speeds    0.20 lock"),
    ):
        board = dashboard("hold", vehicle, speeds=Speeds(0.2, 1.0))
        assert text(speeds_line(board, columns).spans) == words


def test_a_full_stick_means_no_more_than_the_robot_can(tank):
    board = dashboard("hold", tank, speeds=Speeds(99.0, 99.0))
    words = f"full      {tank.max_speed:.2f} m/s u/j  {tank.max_turn:.2f} rad/s i/k"
    assert text(speeds_line(board, 80).spans) == words


def test_the_keys_of_the_speeds_are_those_that_are_bound(tank):
    board = dashboard("hold", tank)._replace(bound=first_keys(KEYMAPS["twist"]))
    assert text(speeds_line(board, 80).spans) == "full      0.30 m/s w/x  1.00 rad/s e/c"
    board = board._replace(bound={"faster": "u"})
    assert text(speeds_line(board, 80).spans) == "full      0.30 m/s  1.00 rad/s"
