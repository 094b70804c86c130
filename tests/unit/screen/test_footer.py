import pytest
from unit.screen.boards import dashboard, status, texts

from zteleop.inputs.keymap import KEYMAPS, first_keys
from zteleop.messages import Stop
from zteleop.screen.footer import footer, hints


@pytest.mark.parametrize(
    ("name", "drive", "shown"),
    [
        ("all", "step", "backspace STOP, arrows drive, space throttle off, x neutral, q quit, ? keys"),
        ("all", "hold", "backspace STOP, arrows drive, space let go, u/j speed, q quit, ? keys"),
        ("wasd", "hold", "backspace STOP, wasd drive, space let go, u/j speed, q quit, ? keys"),
        ("donkey", "step", "backspace STOP, arrows drive, space throttle off, q quit, ? keys"),
        ("course", "step", "backspace STOP, wasd drive, q quit, ? keys"),
        ("twist", "hold", "backspace STOP, ij,l drive, k let go, w/x speed, ctrl-c quit, ? keys"),
    ],
)
def test_the_hints_are_the_keys_that_are_bound(car, name, drive, shown):
    board = dashboard(drive, car)._replace(bound=first_keys(KEYMAPS[name]))
    assert ", ".join(" ".join(hint) for hint in hints(board)) == shown


def test_keys_of_ones_own_are_told_apart(car):
    own = {"forward": "f1", "left": "a", "reverse": "f2", "right": "d"}
    assert ("f1/a/f2/d", "drive") in hints(dashboard("step", car)._replace(bound=own))


def test_who_turns_on_the_spot_has_keys_for_it(tank):
    assert ("i/k", "turning") in hints(dashboard("hold", tank))


def test_a_stop_brings_the_key_that_releases_it(car):
    board = dashboard("step", car, status=status(stops=[Stop(True, 7, "ann", "")]))
    assert hints(board)[:2] == [("backspace", "STOP"), ("r", "release")]
    assert texts(footer(board, 80, True))[0].startswith("backspace STOP   r release   arrows drive")
