from typing import Any

import pytest
import yaml

from zteleop.errors import MessageError
from zteleop.interfaces.parameters import from_python, to_python
from zteleop.messages import ParameterValue
from zteleop.text.parameter_text import dump, load, nodes, typed

NODE = "/abe/keyboard"


def loaded(text: str, **options: bool) -> dict[str, Any]:
    return {parameter.name: to_python(parameter.value) for parameter in load(text, NODE, **options)}


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("0.5", ParameterValue.DOUBLE, 0.5),
        ("5", ParameterValue.DOUBLE, 5),
        ("1e-3", ParameterValue.DOUBLE, 0.001),
        ("true", ParameterValue.BOOL, True),
        ("[1, 2]", ParameterValue.INTEGER_ARRAY, [1, 2]),
        ("info", ParameterValue.STRING, "info"),
        ("'5'", ParameterValue.STRING, "5"),
        ("5", ParameterValue.STRING, "5"),
        ("on", ParameterValue.STRING, "on"),
        ("2020-01-01", ParameterValue.STRING, "2020-01-01"),
        ("", ParameterValue.STRING, ""),
        ("on", ParameterValue.BOOL, True),
    ],
)
def test_a_value_is_yaml_and_a_text_as_it_stands_where_one_is_wanted(
    text: str, kind: int, value: object
) -> None:
    assert typed(text, kind) == from_python(value)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["", "{a: 1}", "[1, a]", "2020-01-01", "null", "[1", "[[1]]"])
def test_what_no_parameter_can_be_is_refused(text: str) -> None:
    with pytest.raises(MessageError):
        typed(text, ParameterValue.DOUBLE)


def test_names_with_dots_are_nested_and_come_back() -> None:
    values = {
        "speeds.forward": 0.5,
        "speeds.back.most": 0.25,
        "log_level": "info",
        "ticks": [1, 2],
        "on": True,
    }
    text = dump(NODE, values)
    assert yaml.safe_load(text) == {
        NODE: {
            "ros__parameters": {
                "log_level": "info",
                "on": True,
                "speeds": {"back": {"most": 0.25}, "forward": 0.5},
                "ticks": [1, 2],
            }
        }
    }
    assert text.startswith("/abe/keyboard:\n  ros__parameters:\n    log_level: info\n")
    assert loaded(text) == values


def test_a_name_that_is_also_the_beginning_of_another_is_kept() -> None:
    values = {"a": 1, "a.b": 2, "a.b.c": 3}
    assert loaded(dump(NODE, values)) == values


@pytest.mark.parametrize(
    ("name", "counts"),
    [
        ("/abe/keyboard", True),
        ("abe/keyboard", True),
        ("/**", True),
        ("/*/keyboard", True),
        ("/**/keyboard", True),
        ("/abe/**", True),
        ("/abe/*", True),
        ("/*", False),
        ("/abe", False),
        ("/abe/keyboard/x", False),
        ("/abe/key*", False),
        ("keyboard", False),
        ("/bea/keyboard", False),
    ],
)
def test_a_name_in_a_file_may_be_a_pattern(name: str, counts: bool) -> None:
    assert loaded(f"{name}: {{ros__parameters: {{x: 1}}}}") == ({"x": 1} if counts else {})


def test_robots_may_be_nested_and_what_stands_below_wins() -> None:
    text = "/**: {ros__parameters: {x: 1, y: 1}}\nabe: {keyboard: {ros__parameters: {x: 2}}}"
    assert loaded(text) == {"x": 2, "y": 1}
    assert loaded(text, wildcards=False) == {"x": 2}
    assert nodes(text) == ["/**", "/abe/keyboard"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected nodes, each with ros__parameters, at the top; found nothing"),
        ("5", "at the top; found 5"),
        ("/abe/keyboard: 5", "at /abe/keyboard; found 5"),
        ("/abe/keyboard: {ros__parameters: 5}", "expected names and values under ros__parameters, found 5"),
        ("/abe/keyboard: {ros__parameters: {x: null}}", "x: a parameter is"),
        ("/abe/keyboard: {ros__parameters: {x: [1, a]}}", "x: a parameter is"),
        ("[", "expected YAML"),
        (
            "/**: {ros__parameters: " + "{a: " * 30 + "1" + "}" * 30 + "}",
            "expected names and values under a.a.",
        ),
        ("{a: " * 30 + "1" + "}" * 30, "expected nodes"),
    ],
)
def test_what_is_no_such_file_is_refused_in_words(text: str, words: str) -> None:
    with pytest.raises(MessageError) as refusal:
        load(text, NODE)
    assert words in str(refusal.value)
