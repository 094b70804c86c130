import pytest

from zteleop.errors import MessageError
from zteleop.text.yaml_text import LONGEST, load


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("{linear: {x: 0.2}}", {"linear": {"x": 0.2}}),
        ('{"linear": {"x": 0.2}}', {"linear": {"x": 0.2}}),
        ("linear:\n  x: 1\n", {"linear": {"x": 1}}),
        ("{}", {}),
        ("", None),
        ("[1, 2]", [1, 2]),
        (
            "{x: 1e-3, y: -2E+5, z: .5e1, t: 'e5', u: 1e}",
            {"x": 0.001, "y": -2e5, "z": 5, "t": "e5", "u": "1e"},
        ),
        ("{stamp: now}", {"stamp": "now"}),
    ],
)
def test_values_are_yaml(text: str, values: object) -> None:
    assert load(text) == values


@pytest.mark.parametrize("text", ["{linear: {x: 0.2}", "a: b: c", "!!python/name:os.system", "2024-13-45"])
def test_what_is_no_yaml_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(MessageError) as error:
        load(text)
    assert str(error.value).startswith(f"expected YAML such as '{{linear: {{x: 0.2}}}}', found {text!r}: ")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "place"),
    [("{linear: {x: 1}, angular {z: 1}}", "line 1, column 26: "), ("a: 1\nb: {\n", "at its end: ")],
)
def test_a_mistake_is_told_with_its_place(text: str, place: str) -> None:
    with pytest.raises(MessageError, match=place):
        load(text)


@pytest.mark.parametrize(
    "text", ["!!timestamp x", "!!int ''", "!!bool x", "[" * 2000, "2001-99-99", "{[1]: 2}"]
)
def test_what_is_no_yaml_is_said_however_it_fails(text: str) -> None:
    with pytest.raises(MessageError, match="expected YAML such as") as error:
        load(text)
    assert len(str(error.value)) < 400


def test_what_is_too_long_is_not_even_read() -> None:
    with pytest.raises(MessageError, match="expected at most 1048576 characters of YAML, found more"):
        load("x" * (LONGEST + 1))


LAUGHS = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 200_000,
        "{a: " * 100_000,
        "- " * 100_000,
        "? " * 100_000,
        "[" * 5000 + "]" * 5000,
        LAUGHS,
        "&a [*a]",
    ],
    ids=["lists", "maps", "items", "keys", "closed", "laughs", "itself"],
)
def test_a_bomb_is_refused_before_it_is_built(text: str) -> None:
    with pytest.raises(
        MessageError, match=r"nested more than 100 deep|stands within itself|maximum nesting depth"
    ):
        load(text)


@pytest.mark.parametrize(
    "text", ["0x" + "f" * 5000, "1:" * 5000 + "1", "1" * 5000], ids=["hex", "sixty", "int"]
)
def test_a_number_of_thousands_of_digits_is_none(text: str) -> None:
    with pytest.raises(MessageError, match="a number has at most 400 digits"):
        load(text)


def test_what_repeats_a_little_is_no_bomb() -> None:
    assert load("{a: &a {x: 1}, b: *a}") == {"a": {"x": 1}, "b": {"x": 1}}
    assert len(load("[" + "-1, " * 5000 + "]")) == 5000
