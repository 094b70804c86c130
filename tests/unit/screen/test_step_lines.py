import pytest
from unit.screen.boards import dashboard

from zteleop.messages import Pwm
from zteleop.screen.step_lines import bar, step_lines


def texts(lines) -> list[str]:
    return ["".join(span.text for span in line.spans) for line in lines]


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
    shown = texts(step_lines(dashboard("step", car, command=Pwm(steering, throttle)), 80))
    assert tuple(shown[2:4]) == lines


def test_right_is_right_whichever_number_is_larger(car):
    channel = car.channels[0]
    channel.min_ticks, channel.max_ticks = channel.max_ticks, channel.min_ticks
    shown = texts(step_lines(dashboard("step", car, command=Pwm(390, 370)), 80))
    assert shown[2] == "steering  [      O>     ]  right 1/6"


@pytest.mark.parametrize("pwm", [None, Pwm(330, 399)])
def test_bars_and_their_words_fit(car, pwm):
    board = dashboard("step", car, command=pwm) if pwm else dashboard("step")
    for columns in range(20, 81):
        bars = texts(step_lines(board, columns))[2:]
        assert all("]" in text for text in bars)
        assert columns < 34 or all(len(text) <= columns for text in bars)
