import re
from pathlib import Path

import pytest

from zteleop.inputs.evdev.codes import ALTS, AXES, BUTTONS, CTRLS, KEYS, NAMES, SHIFTS, SUPERS, TAB, TYPED

HEADER = Path("/usr/include/linux/input-event-codes.h")


@pytest.mark.parametrize(
    ("code", "name"),
    [
        (17, "w"),
        (30, "a"),
        (31, "s"),
        (32, "d"),
        (103, "up"),
        (106, "right"),
        (57, "space"),
        (14, "backspace"),
    ],
)
def test_keys_are_named_as_keymaps_say_them(code: int, name: str) -> None:
    assert KEYS[code] == name


def test_groups_are_of_one_name() -> None:
    assert {KEYS[code] for code in SHIFTS} == {"shift"}
    assert {KEYS[code] for code in CTRLS} == {"ctrl"}
    assert {KEYS[code] for code in ALTS} == {"alt"}
    assert {KEYS[code] for code in SUPERS} == {"super"}
    assert KEYS[TAB] == "tab"
    assert {KEYS[code] for code in TYPED} == {"w", "a", "s", "d", "space"}


def test_no_two_controls_share_a_number() -> None:
    assert len(NAMES) == len(AXES) + len(BUTTONS)


@pytest.mark.skipif(
    not HEADER.exists(), reason="needs the kernel's headers (sudo apt install linux-libc-dev)"
)
def test_numbers_are_the_kernels() -> None:
    found = re.findall(r"#define\s+((?:BTN|ABS)_\w+)\s+(\w+)", HEADER.read_text())
    kernel = {name: int(number, 0) for name, number in found if number[0].isdigit()}
    for name, number in {**AXES, **BUTTONS}.items():
        assert kernel[name] == number
