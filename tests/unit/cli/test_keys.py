import tomllib

import msgspec
import pytest

from zteleop.cli.keys import Seen
from zteleop.config import Config
from zteleop.inputs.keymap import bindings
from zteleop.terminal.keys import Key


def seen(*keys: Key, keymap: str = "all") -> Seen:
    found = Seen(bindings({}, keymap))
    found.take(keys)
    return found


def test_each_key_is_shown_with_what_it_does() -> None:
    page = seen(Key("up"), Key("W", "repeat"), Key("f5", "release")).page(True, 80, 24)
    assert page[:2] == ["This terminal tells when a key is let go.", "Press keys; Ctrl-C ends."]
    assert page[-3:] == [
        "up            press     forward",
        "W             repeat    forward",
        "f5            release   bound to nothing",
    ]


def test_a_map_that_binds_every_other_key_says_so() -> None:
    assert seen(Key("f5"), keymap="twist").page(False, 80, 24)[-1] == "f5            press     neutral"


def test_a_small_window_shows_the_newest() -> None:
    page = seen(*(Key(f"f{number}") for number in range(1, 10))).page(False, 20, 6)
    assert len(page) == 6
    assert page[-1].startswith("f9")
    assert all(len(line) <= 20 for line in page)


def test_only_ctrl_c_ends() -> None:
    assert not seen(Key("q"), Key("c")).enough
    assert seen(Key("ctrl-c")).enough


@pytest.mark.parametrize("key", ["f5", "ctrl-up", "?", ";", "é", "\\", '"', "'"])
def test_what_is_advised_can_be_pasted(key: str) -> None:
    found = Seen(bindings({}, "donkey") | {"?": ""})
    found.take([Key(key)])
    text = "\n".join(found.advice()[1:])
    settings = msgspec.convert(tomllib.loads(text), Config)
    assert settings.keys == {key: "stop robot"}


def test_where_every_key_does_something_nothing_is_advised() -> None:
    assert seen(Key("up"), Key("down")).advice() == []


def test_a_keyboard_of_any_number_of_keys_fills_no_memory() -> None:
    found = seen(*(Key(chr(256 + number)) for number in range(5000)))
    assert len(found._rows) <= 200
    assert len(found._free) <= 200
