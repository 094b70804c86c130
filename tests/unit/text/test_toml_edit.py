"""A config file keeps what its owner wrote."""

import msgspec
import pytest

from zteleop.text.toml_edit import edited

FILE = """\
# my car
robot = "abe"   # its name

[drive.servos.steering]  # measured on Tuesday
channel = 1
min_us = 1183.2          # full right: 290 ticks
max_us = 1876.8          # full left

[bus]
mode = "peer"
"""


def test_a_value_changes_and_nothing_else() -> None:
    text = edited(FILE, {("drive", "servos", "steering", "max_us"): 1900.0})
    assert text == FILE.replace("1876.8", "1900.0")


def test_what_is_not_there_yet_is_added_where_it_belongs() -> None:
    text = edited(FILE, {("drive", "servos", "throttle", "channel"): 0, ("bus", "patience"): 2.0})
    values = msgspec.toml.decode(text)
    assert values["drive"]["servos"]["throttle"] == {"channel": 0}
    assert values["bus"] == {"mode": "peer", "patience": 2.0}
    assert text.startswith(FILE.split("[bus]")[0].rstrip())


@pytest.mark.parametrize("path", [("driver",), ("a", "b"), ("a", "b", "c", "d")])
def test_an_empty_file_takes_values_of_any_depth(path: tuple[str, ...]) -> None:
    found = msgspec.toml.decode(edited("", {path: 1}))
    for name in path:
        found = found[name]
    assert found == 1


def test_a_value_before_any_table_stays_out_of_the_tables() -> None:
    assert msgspec.toml.decode(edited(FILE, {("driver",): "simulated"}))["driver"] == "simulated"


def test_a_comment_that_tells_the_number_before_tells_the_one_after() -> None:
    path = ("drive", "servos", "steering", "min_us")
    text = edited(FILE, {path: 1200.0}, {path: (290, 294)})
    assert "min_us = 1200.0          # full right: 294 ticks\n" in text


def test_a_comment_with_another_number_stays() -> None:
    path = ("drive", "servos", "steering", "min_us")
    assert "# full right: 290 ticks" in edited(FILE, {path: 1200.0}, {path: (29, 30)})


def test_inline_tables_and_dotted_names_are_changed_in_place() -> None:
    text = edited(
        "drive.servos.steering = {channel = 1, min_us = 1000.0}\n",
        {("drive", "servos", "steering", "min_us"): 1.5},
    )
    assert msgspec.toml.decode(text) == {"drive": {"servos": {"steering": {"channel": 1, "min_us": 1.5}}}}
