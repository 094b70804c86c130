import pytest

from zteleop.errors import ConfigError
from zteleop.inputs.keyboard import ACTIONS
from zteleop.inputs.keymap import DIRECTIONS, DOES, KEYMAPS, OTHER, SPEEDS, bindings, describe, first_keys


@pytest.mark.parametrize("name", KEYMAPS)
def test_every_key_has_an_action_there_is(name):
    assert set(KEYMAPS[name].values()) <= {*ACTIONS, *DIRECTIONS}


@pytest.mark.parametrize("name", KEYMAPS)
def test_the_stop_its_release_and_the_end_are_the_same_in_every_map(name):
    for key, action in (
        ("backspace", "stop robot"),
        ("r", "release robot"),
        ("ctrl-c", "quit"),
        ("?", "help"),
    ):
        assert KEYMAPS[name][key] == action


def test_keys_are_added_to_the_usual_ones():
    known = bindings({"8": "forward", "w": "stop"})
    assert (known["8"], known["w"], known["up"]) == ("forward", "stop", "forward")
    assert "up" not in bindings({}, "wasd")


def test_an_unknown_action_is_refused_with_those_there_are():
    with pytest.raises(ConfigError, match=r"key 'z': no action 'quti'; did you mean quit\?"):
        bindings({"z": "quti"})
    with pytest.raises(ConfigError, match=r"no keymap 'donky'; did you mean donkey\?"):
        bindings({}, "donky")


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"ctrl-c": "forward"}, "key 'ctrl-c' quits, whatever else does; found 'forward'"),
        ({"backspace": "nothing"}, "no key stops the robot; bind one to 'stop robot'"),
    ],
)
def test_the_way_out_and_the_stop_are_never_taken_away(keys, words):
    with pytest.raises(ConfigError, match=words):
        bindings(keys)
    assert bindings({"backspace": "nothing", "f1": "stop robot"})["f1"] == "stop robot"


def test_every_action_is_told_in_words():
    assert {*DOES} == {*ACTIONS, *DIRECTIONS}
    keys = KEYMAPS["all"]
    assert sorted(" ".join(keys for keys, _ in describe(keys)).split()) == sorted(keys)
    assert ("any other", "throttle off, wheels straight") in describe({OTHER: "neutral"})
    assert not {does for _, does in describe(keys, "step")} & {DOES[action] for action in SPEEDS}


def test_the_first_key_of_an_action_is_the_one_to_name():
    found = first_keys({"up": "forward", "ctrl-c": "quit", "w": "forward", OTHER: "neutral", "z": "quit"})
    assert found == {"forward": "up", "quit": "z"}


@pytest.mark.parametrize(
    "action", ["toggle ", "toggle Lights", "toggle a/b", "toggle cmd vel", "toggle x" * 9]
)
def test_a_switch_has_the_name_of_a_topic(action):
    with pytest.raises(ConfigError, match="key 'l': a switch has a name such as lights_2"):
        bindings({"l": action})


@pytest.mark.parametrize("key", ["backspac", "ctrl-uup", "", "up down"])
def test_a_key_that_there_is_not_is_refused(key):
    with pytest.raises(ConfigError, match="no key is called"):
        bindings({key: "stop robot"})


@pytest.mark.parametrize("key", ["f5", "ctrl-up", "alt-super-x", "é", "?", "backspace", OTHER])
def test_a_key_has_a_letter_or_a_name(key):
    assert bindings({key: "stop robot"})[key] == "stop robot"


def test_all_that_is_wrong_with_keys_is_said_at_once():
    with pytest.raises(ConfigError) as told:
        bindings({"f1": "stop robt", "backspac": "stop robot", "l": "toggle L"})
    for words in ("no action 'stop robt'", "no key is called 'backspac'", "a switch has a name"):
        assert words in str(told.value)
