import pytest

from zteleop.errors import ConfigError
from zteleop.inputs.keyboard import ACTIONS
from zteleop.inputs.keymap import DIRECTIONS, DOES, KEYS, bindings, describe


def test_every_key_has_an_action_there_is():
    assert set(KEYS.values()) <= {*ACTIONS, *DIRECTIONS}


def test_the_stop_and_its_release_have_a_key_each():
    assert [key for key, action in KEYS.items() if action == "stop robot"] == ["backspace"]
    assert [key for key, action in KEYS.items() if action == "release robot"] == ["r"]


def test_keys_are_added_to_the_usual_ones():
    known = bindings({"8": "forward", "w": "stop"}, {"forward", "stop"})
    assert (known["8"], known["w"], known["up"]) == ("forward", "stop", "forward")


def test_an_unknown_action_is_refused_with_those_there_are():
    with pytest.raises(ConfigError, match=r"key 'z' is bound to 'fly'; expected one of forward, stop"):
        bindings({"z": "fly"}, {"forward", "stop"})


def test_every_action_is_told_in_words():
    assert {*DOES} == {*ACTIONS, *DIRECTIONS}
    assert sorted(" ".join(keys for keys, _ in describe(KEYS)).split()) == sorted(KEYS)
