from typing import Annotated, Any, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Meta, Struct, convert

from zteleop.config import Config
from zteleop.text import mistakes as module
from zteleop.text.mistakes import mistakes


class Wheel(Struct, forbid_unknown_fields=True):
    channel: Annotated[int, Meta(ge=0, le=15)]
    width: Annotated[float, Meta(gt=0)] = 1.0


class Car(Struct, tag="car", tag_field="kind", frozen=True, forbid_unknown_fields=True):
    length: Annotated[float, Meta(gt=0, le=2)] = 0.3


class Tank(Struct, tag="tank", tag_field="kind", frozen=True, forbid_unknown_fields=True):
    track: float = 0.2


class Frame(Struct, forbid_unknown_fields=True):
    width: float = 0.5


class Robot(Struct, forbid_unknown_fields=True):
    name: str | None = None
    mode: Literal["peer", "client"] = "peer"
    on: bool = True
    connect: list[str] = []
    wheels: dict[str, Wheel] = {}
    frame: Frame | None = None
    body: Car | Tank = Car()
    extra: dict[str, dict[str, Any]] = {}

    def __post_init__(self) -> None:
        if self.name == "nobody":
            raise ValueError("nobody is no name")
        if self.name == "abe" and not self.on:
            raise ValueError("abe is always on")


def told(values: object) -> list[str]:
    kinds = {("extra", "pad"): Wheel}
    return [f"{'.'.join(path)}: {words}" for path, words in mistakes(values, Robot, kinds)]


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, []),
        ({"name": "abe", "body": {"kind": "tank", "track": 1}, "extra": {"new": {"any": 1}}}, []),
        ({"nmae": "abe"}, ["nmae: no such setting; did you mean name?"]),
        ({"width": 1}, ["width: no such setting; did you mean frame.width?"]),
        ({"mode": "pear"}, ["mode: expected 'client' or 'peer', found 'pear'; did you mean peer?"]),
        ({"mode": 3}, ["mode: expected 'client' or 'peer', found 3"]),
        ({"on": "yes"}, ["on: expected true or false, found 'yes'"]),
        ({"name": True}, ["name: expected text, found true"]),
        ({"connect": "tcp/a:1"}, ["connect: expected a list, each of it text, found 'tcp/a:1'"]),
        ({"wheels": 1}, ["wheels: expected a table, found 1"]),
        ({"wheels": {"left": []}}, ["wheels.left: expected a table, found a list"]),
        ({"wheels": {"left": {}}}, ["wheels.left: expected channel as well"]),
        (
            {"wheels": {"left": {"channel": 99, "width": 0}, "right": {"channel": 1.5}}},
            [
                "wheels.left.channel: expected a whole number from 0 to 15, found 99",
                "wheels.left.width: expected a number above 0, found 0",
                "wheels.right.channel: expected a whole number from 0 to 15, found 1.5",
            ],
        ),
        (
            {"body": {"kind": "tnak"}},
            ["body.kind: expected 'car' or 'tank', found 'tnak'; did you mean tank?"],
        ),
        ({"body": {"kind": []}}, ["body.kind: expected 'car' or 'tank', found a list"]),
        ({"body": {"length": 1}}, ["body: expected a table with kind = 'car' or 'tank', found a table"]),
        (
            {"body": {"kind": "car", "length": 3}},
            ["body.length: expected a number above 0 and at most 2, found 3"],
        ),
        ({"body": {"kind": "car", "track": 3}}, ["body.track: no such setting; known: length"]),
        (
            {"extra": {"pad": {"channel": -1}}},
            ["extra.pad.channel: expected a whole number from 0 to 15, found -1"],
        ),
        ({"name": "nobody"}, ["name: nobody is no name"]),
        ({"name": "abe", "on": False}, [": abe is always on"]),
        ({"name": "abe", "on": False, "mode": "x"}, ["mode: expected 'client' or 'peer', found 'x'"]),
        ([], [": expected a table, found a list"]),
        ({"name": ["x" * 99]}, ["name: expected text, found a list"]),
        ({"mode": "x" * 99}, [f"mode: expected 'client' or 'peer', found '{'x' * 59}..."]),
    ],
)
def test_every_mistake_is_told_where_it_is(values: object, words: list[str]) -> None:
    assert told(values) == words


def test_no_more_is_looked_at_than_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stop reads the file, too: it waits for no thousand suggestions."""
    asked: list[str] = []
    monkeypatch.setattr(module, "nearest", lambda name, known: asked.append(name) or "")
    found = mistakes({f"x{number}": 1 for number in range(1000)}, Robot)
    assert [next(found).path for _ in range(2)] == [("x0",), ("x1",)]
    assert asked == ["x0", "x1"]


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=2)
        | st.dictionaries(
            st.sampled_from([*Robot.__struct_fields__, "kind", "channel", "x"]), inner, max_size=3
        )
    ),
    max_leaves=8,
)


@given(PLAIN)
def test_whatever_is_refused_is_told_and_nothing_else(values: object) -> None:
    for kind in (Robot, Config):
        try:
            convert(values, kind)
        except ValueError:
            assert list(mistakes(values, kind))
        else:
            assert list(mistakes(values, kind)) == []
