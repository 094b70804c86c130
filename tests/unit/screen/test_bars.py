import pytest
from unit.screen.boards import dashboard, pulses, status, text, texts

from zteleop.control.stick import Stick
from zteleop.messages import Pwm, Twist
from zteleop.screen.bars import Reach, bar_lines, bar_spans, share
from zteleop.screen.dashboard import Task


def bar(asked: int, out: int, cells: int = 6, axis: str = "steering", unicode: bool = False) -> str:
    return text(bar_spans(axis, Reach(asked, out, cells, ""), unicode))[10:].rstrip()


def test_the_bar_grows_a_mark_a_step_and_is_as_wide_as_the_most():
    assert bar(3, 3) == "[      O>>>   ]"
    assert bar(-2, -2) == "[    <<O      ]"
    assert bar(0, 0) == "[      O      ]"
    assert bar(6, 6, axis="throttle") == "[      O++++++]"


def test_with_unicode_it_is_of_blocks():
    assert bar(-2, -2, unicode=True) == "▕    ██│      ▏"


@pytest.mark.parametrize(
    ("asked", "out", "drawn"),
    [
        (3, 0, "[      O...   ]"),
        (3, 1, "[      O>..   ]"),
        (1, 3, "[      O>>>   ]"),
        (-2, 2, "[    ..O>>    ]"),
    ],
)
def test_what_is_asked_but_not_put_out_is_hollow(asked, out, drawn):
    assert bar(asked, out) == drawn


def test_what_is_put_out_has_a_colour_and_what_is_only_asked_is_dim():
    spans = bar_spans("throttle", Reach(2, 1, 2, ""), True)
    assert [span.style for span in spans if span.text in "█░"] == ["green", "dim"]
    assert "cyan" in [span.style for span in bar_spans("steering", Reach(2, 1, 2, ""), True)]


@pytest.mark.parametrize(
    ("steering", "throttle", "lines"),
    [
        (375, 370, ("steering  [      O      ]  straight", "throttle  [        O        ]  neutral")),
        (330, 372, ("steering  [      O>>>   ]  right 3/6", "throttle  [        O+       ]  forward 2/30")),
        (460, 355, ("steering  [<<<<<<O      ]  left 6/6", "throttle  [    ----O        ]  reverse 15/15")),
    ],
)
def test_the_levers_are_bars(car, steering, throttle, lines):
    said = status(pulses=pulses(car, {"steering": steering, "throttle": throttle}))
    board = dashboard("step", car, command=Pwm(steering, throttle), status=said)
    assert tuple(texts(bar_lines(board, 80, False))) == lines


@pytest.mark.parametrize("said", [None, status(confirmed="cut")])
def test_without_a_pulse_nothing_is_put_out(car, said):
    if said:
        said.pulses = pulses(car, {"steering": 330})
    board = dashboard("step", car, command=Pwm(330, 370), status=said)
    assert texts(bar_lines(board, 80, False))[0] == "steering  [      O...   ]  right 3/6"


@pytest.mark.parametrize("drive", ["step", "hold"])
def test_where_nobody_tells_what_the_chip_does_it_is_not_known(car, drive):
    lines = texts(bar_lines(dashboard(drive, car, status=None), 80, False))
    assert all(line.endswith("not known") for line in lines)


def test_right_is_right_whichever_number_is_larger(car):
    channel = car.channels[0]
    channel.min_ticks, channel.max_ticks = channel.max_ticks, channel.min_ticks
    shown = texts(bar_lines(dashboard("step", car, command=Pwm(390, 370)), 80, False))
    assert shown[0] == "steering  [      O.     ]  right 1/6"


def test_steps_are_counted_from_the_end_of_the_dead_zone(car):
    car.channels[1].dead_ticks = 3
    shown = texts(bar_lines(dashboard("step", car, command=Pwm(375, 374)), 80, False))
    assert shown[1].endswith("forward 1/27")


def test_held_keys_are_bars_of_what_the_robot_can(car):
    said = status(pulses=pulses(car, {"steering": 460, "throttle": 385}))
    asked = {"stick": Stick(1.0, 1.0, True), "command": Twist.planar(1.0, 1.0)}
    shown = texts(bar_lines(dashboard("hold", car, status=said, **asked), 80, False))
    assert shown == [
        "steering  [<<<<<<<<O        ]  left",
        "throttle  [        O++++....]  forward",
    ]


def test_a_tank_turns_by_its_tracks_together(tank):
    said = status(applied=Twist.planar(-0.15, -1.5))
    shown = texts(
        bar_lines(dashboard("hold", tank, status=said, command=Twist.planar(-0.3, -1.5)), 80, False)
    )
    assert shown == [
        "steering  [        O>>>>>>>>]  right",
        "throttle  [....----O        ]  reverse",
    ]


@pytest.mark.parametrize("pwm", [None, Pwm(330, 399)])
def test_bars_and_their_words_fit(car, pwm):
    board = dashboard("step", car, command=pwm) if pwm else dashboard("step")
    for columns in range(20, 81):
        bars = texts(bar_lines(board, columns, False))
        assert all("]" in text for text in bars)
        assert columns < 34 or all(len(text) <= columns for text in bars)


def test_while_another_drives_the_words_are_of_what_is_put_out(car, tank):
    said = status(pulses=pulses(car, {"steering": 330, "throttle": 372}))
    for drive, words in (("step", ["right 3/6", "forward 2/30"]), ("hold", ["right", "forward"])):
        shown = texts(bar_lines(dashboard(drive, car, status=said), 80, False))
        assert [line.rpartition("]  ")[2] for line in shown] == words
    said = status(applied=Twist.planar(-0.1, 0.5))
    shown = texts(bar_lines(dashboard("hold", tank, status=said), 80, False))
    assert [line.rpartition("]  ")[2] for line in shown] == ["left", "reverse"]
    said = status(pulses=pulses(car, {"steering": 376, "throttle": 371}))
    shown = texts(bar_lines(dashboard("step", car, status=said), 80, False))
    assert [line.rpartition("]  ")[2] for line in shown] == ["left 1 tick", "forward 1/30"], "of 15 a step"


@pytest.mark.parametrize(
    ("fraction", "filled"), [(0.1, 1), (-0.1, -1), (1.0, 8), (3.0, 8), (-1e308, -8), (float("inf"), 0)]
)
def test_no_fraction_passes_the_end_however_large(fraction, filled):
    assert share(fraction, 8) == filled


def test_while_a_servo_is_measured_its_sides_have_no_names(car):
    said = status(pulses=pulses(car, {"steering": 385}))
    board = dashboard("step", car, command=Pwm(385, 370), status=said)
    assert " left " in texts(bar_lines(board, 80, True))[0]
    measured = texts(bar_lines(board._replace(task=Task(unmeasured=True)), 80, True))
    assert measured[0].rstrip().endswith("+10 ticks"), "it may be built in upside down"
