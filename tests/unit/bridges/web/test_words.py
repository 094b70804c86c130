import json
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Raw

from zteleop.bridges.web.words import Heard, Held, Hello, Note, Watch, Wheel, Wish, read, text
from zteleop.errors import MessageError

HELD = {"is": "held", "seq": 7, "drive": 0.5, "turn": -1, "deadman": True, "epoch": 9, "beat": 12.5}


@pytest.mark.parametrize(
    ("said", "word"),
    [
        (HELD, Held(7, 0.5, -1.0, True, 9, 12.5)),
        ({"is": "wish", "of": "stop", "why": "a cat"}, Wish("stop", "a cat")),
        ({"is": "wish", "of": "hand over"}, Wish("hand over")),
        ({"is": "watch", "topics": ["odom"]}, Watch(["odom"])),
    ],
)
def test_what_a_page_says_is_understood(said: object, word: object) -> None:
    assert read(json.dumps(said)) == word


@pytest.mark.parametrize(
    "frame",
    [
        "",
        "{}",
        "[]",
        '{"is": "shutdown"}',
        '{"is": "wish", "of": "drive"}',
        json.dumps(HELD | {"drive": 1.01}),
        json.dumps(HELD | {"drive": None}),
        json.dumps(HELD | {"seq": -1}),
        json.dumps(HELD | {"sudo": True}),
        json.dumps({key: value for key, value in HELD.items() if key != "beat"}),
        json.dumps({"is": "watch", "topics": ["odom"] * 65}),
        json.dumps({"is": "watch", "topics": ["x" * 201]}),
        '{"is": "held", "seq": NaN}',
        "\ud800",
        b"held",
    ],
)
def test_anything_else_is_refused_in_a_sentence(frame: str | bytes) -> None:
    with pytest.raises(MessageError, match=r"^expected "):
        read(frame)


@given(st.text())
def test_any_text_is_a_word_or_an_error(frame: str) -> None:
    with suppress(MessageError):
        read(frame)


def test_what_is_said_on_the_bus_passes_as_it_is() -> None:
    said = b'{"is_moving":false, "x":1.0}'
    assert json.loads(text(Heard("odom", "a/b", Raw(said)))) == {
        "is": "heard",
        "topic": "odom",
        "type": "a/b",
        "message": json.loads(said),
    }
    assert said.decode() in text(Heard("odom", "a/b", Raw(said)))


def test_every_word_of_a_server_says_what_it_is() -> None:
    words = [
        Hello("archangel", "1.0", "page 1"),
        Wheel("", ["page 1"]),
        Note("hello"),
        Heard("a", "b", Raw(b"1")),
    ]
    assert [json.loads(text(word))["is"] for word in words] == ["hello", "wheel", "note", "heard"]
