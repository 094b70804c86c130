from math import isfinite, pi
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import ConfigError
from zteleop.text.quantity import KINDS, Dimension, quantity

UNITS = [(dimension, unit) for dimension, kind in KINDS.items() for unit in kind.units]


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("0.2m/s", "speed", 0.2),
        ("20cm/s", "speed", 0.2),
        ("200 mm/s", "speed", 0.2),
        ("3.6km/h", "speed", 1.0),
        ("-0.2m/s", "speed", -0.2),
        ("+.5", "speed", 0.5),
        ("30deg/s", "turn", pi / 6),
        ("30°/s", "turn", pi / 6),
        ("0.5rad/s", "turn", 0.5),
        ("50cm", "length", 0.5),
        ("1m", "length", 1.0),
        ("1in", "length", 0.0254),
        ("2km", "length", 2000.0),
        (" 5e-1 m ", "length", 0.5),
        ("90deg", "angle", pi / 2),
        ("1", "angle", 1.0),
        ("2s", "time", 2.0),
        ("500ms", "time", 0.5),
        ("2min", "time", 120.0),
    ],
)
def test_a_quantity_is_what_people_mean_by_it(text: str, dimension: Dimension, value: float) -> None:
    assert quantity(text, dimension) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "dimension", "words"),
    [
        ("50cm", "speed", "expected a speed such as 0.2m/s, found '50cm', which is a length"),
        ("30deg/s", "speed", "expected a speed such as 0.2m/s, found '30deg/s', which is a turning speed"),
        ("2s", "angle", "expected an angle such as 90deg, found '2s', which is a time"),
        ("fast", "speed", "expected a speed such as 0.2m/s, found 'fast'"),
        ("", "length", "expected a length such as 50cm, found ''"),
        ("m", "length", "expected a length such as 50cm, found 'm'; write number and unit together"),
        ("0,2m", "length", "expected a length such as 50cm, found '0,2m'; a decimal point is a point"),
        (
            "1m,1m",
            "length",
            "expected a length such as 50cm, found '1m,1m'; that is two of them: write a space",
        ),
        (
            "1e400m",
            "length",
            "expected a length such as 50cm, found '1e400m', which is too large for a number",
        ),
        ("nan", "length", "expected a length such as 50cm, found 'nan'"),
        ("inf", "length", "expected a length such as 50cm, found 'inf'"),
        (
            "2 kmh",
            "speed",
            "expected a speed such as 0.2m/s, found '2 kmh'; no unit 'kmh', did you mean km/h?",
        ),
        (
            "90degrees",
            "angle",
            "expected an angle such as 90deg, found '90degrees'; no unit 'degrees', did you mean deg?",
        ),
    ],
)
def test_what_is_no_such_quantity_is_said_in_one_sentence(
    text: str, dimension: Dimension, words: str
) -> None:
    with pytest.raises(ConfigError) as error:
        quantity(text, dimension)
    assert str(error.value) == words


@given(
    st.floats(-1e6, 1e6),
    st.sampled_from(UNITS),
    st.sampled_from(["", " ", "  "]),
)
def test_a_number_with_a_unit_is_that_many_of_it(
    number: float, unit: tuple[Dimension, str], space: str
) -> None:
    dimension, name = unit
    assert quantity(f"{number!r}{space}{name}", dimension) == number * KINDS[dimension].units[name]
    assert quantity(f"{number!r}", dimension) == number


@given(st.text(max_size=60), st.sampled_from(get_args(Dimension)))
def test_any_text_is_a_finite_number_or_one_sentence(text: str, dimension: Dimension) -> None:
    says = refusal(text, dimension)
    assert says == "" or says.startswith("expected ")
    assert "\n" not in says
    assert len(says) < 400


def refusal(text: str, dimension: Dimension) -> str:
    try:
        assert isfinite(quantity(text, dimension))
    except ConfigError as error:
        return str(error)
    return ""


def test_the_example_of_each_dimension_is_one() -> None:
    for dimension, kind in KINDS.items():
        assert quantity(kind.example, dimension) > 0


@pytest.mark.parametrize("unit", ["m/s", "cm", " deg "])
def test_a_unit_without_its_number_was_typed_with_a_space(unit: str) -> None:
    with pytest.raises(ConfigError, match=r"write number and unit together$"):
        quantity(unit, "turn")
