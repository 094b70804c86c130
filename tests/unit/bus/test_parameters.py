from typing import Any

import pytest

from zteleop.bus.parameters import SERVICES, Bounds, Parameters
from zteleop.errors import ConfigError, MessageError
from zteleop.interfaces.parameters import from_python, to_python
from zteleop.messages import (
    DescribeParametersRequest,
    GetParametersRequest,
    ListParametersRequest,
    Parameter,
    ParameterValue,
    SetParametersRequest,
)


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def parameters(said: list[str]) -> Parameters:
    parameters = Parameters(said.append)
    parameters.declare("limits.speed", 2.0, "m/s", Bounds(0.1, 3.0))
    parameters.declare("limits.turn.left", 1.0)
    parameters.declare("gears", 3, "", Bounds(1, 5))
    parameters.declare("log_level", "info", "", Bounds(choices=("info", "warn")))
    return parameters


def set_to(parameters: Parameters, name: str, value: Any) -> str:
    """Change a parameter, and return why not."""
    request = SetParametersRequest([Parameter(name, from_python(value))])
    (result,) = parameters.set(request).results
    assert result.successful == (not result.reason)
    return result.reason


def test_a_value_is_changed_and_told(parameters: Parameters, said: list[str]) -> None:
    speed = parameters.declare("speed", 1.0)
    assert set_to(parameters, "speed", 0.5) == ""
    assert speed.value == 0.5
    assert said == ["speed is 0.5 now, and was 1.0"]


def test_the_same_value_is_no_news(parameters: Parameters, said: list[str]) -> None:
    assert set_to(parameters, "gears", 3) == ""
    assert said == []


def test_a_whole_number_does_for_a_double(parameters: Parameters) -> None:
    assert set_to(parameters, "limits.speed", 3) == ""
    (value,) = parameters.get(GetParametersRequest(["limits.speed"])).values
    assert (value.type, value.double_value) == (ParameterValue.DOUBLE, 3.0)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("limits.speed", 3.1, "limits.speed: expected 0.1 to 3, found 3.1"),
        ("limits.speed", 0.0, "limits.speed: expected 0.1 to 3, found 0.0"),
        ("limits.speed", float("nan"), "limits.speed: expected 0.1 to 3, found nan"),
        ("limits.speed", "fast", "limits.speed: expected double, such as 0.3, found 'fast'"),
        ("gears", 2.5, "gears: expected integer, such as 3, found 2.5"),
        ("gears", True, "gears: expected integer, such as 3, found True"),
        ("log_level", "wran", "log_level: expected info or warn, found wran"),
        ("limits.sped", 1.0, "no parameter 'limits.sped'; did you mean limits.speed?"),
    ],
)
def test_what_does_not_fit_is_refused_and_changes_nothing(
    parameters: Parameters, said: list[str], name: str, value: Any, words: str
) -> None:
    before = parameters.get(GetParametersRequest(["limits.speed", "gears", "log_level"]))
    assert set_to(parameters, name, value).startswith(words)
    assert parameters.get(GetParametersRequest(["limits.speed", "gears", "log_level"])) == before
    assert said == []


def test_nothing_is_no_value(parameters: Parameters) -> None:
    (result,) = parameters.set(SetParametersRequest([Parameter("gears", ParameterValue.zero())])).results
    assert result.reason == "gears: expected a value, found not set"


def test_whoever_declared_it_hears_of_a_value_before_it_counts_and_may_refuse_it(
    parameters: Parameters,
) -> None:
    heard: list[float] = []

    def changed(value: float) -> None:
        heard.append(found.value)
        if value > 5:
            raise ConfigError("too hot")

    found = parameters.declare("heat", 1.0, changed=changed)
    assert set_to(parameters, "heat", 9.0) == "heat: too hot"
    assert set_to(parameters, "heat", 2.0) == ""
    assert (heard, found.value) == ([1.0, 1.0], 2.0)


def test_each_of_several_is_told_whether_it_was_changed(parameters: Parameters) -> None:
    wanted = [Parameter(name, from_python(value)) for name, value in (("gears", 9), ("limits.speed", 1.0))]
    results = parameters.set(SetParametersRequest(wanted)).results
    assert [result.successful for result in results] == [False, True]


@pytest.mark.parametrize(
    ("prefixes", "depth", "found"),
    [
        ([], 0, ["gears", "limits.speed", "limits.turn.left", "log_level"]),
        ([], 1, ["gears", "log_level"]),
        (["limits"], 0, ["limits.speed", "limits.turn.left"]),
        (["limits"], 1, ["limits.speed"]),
        (["limit"], 0, []),
    ],
)
def test_names_are_listed_below_a_prefix_and_so_deep(
    parameters: Parameters, prefixes: list[str], depth: int, found: list[str]
) -> None:
    result = parameters.list(ListParametersRequest(prefixes, depth)).result
    assert result.names == found
    assert result.prefixes == sorted({name.rpartition(".")[0] for name in found if "." in name})


def test_what_there_is_none_of_is_not_set(parameters: Parameters) -> None:
    values = parameters.get(GetParametersRequest(["nothing", "gears"])).values
    assert [to_python(value) for value in values] == [None, 3]
    described = parameters.describe(DescribeParametersRequest(["nothing"])).descriptors
    assert [one.type for one in described] == [ParameterValue.NOT_SET]


def test_what_it_may_be_is_told(parameters: Parameters) -> None:
    names = ["limits.speed", "gears", "log_level", "limits.turn.left"]
    speed, gears, level, left = parameters.describe(DescribeParametersRequest(names)).descriptors
    assert (speed.name, speed.type, speed.description) == ("limits.speed", ParameterValue.DOUBLE, "m/s")
    assert [(r.from_value, r.to_value) for r in speed.floating_point_range] == [(0.1, 3.0)]
    assert [(r.from_value, r.to_value, r.step) for r in gears.integer_range] == [(1, 5, 1)]
    assert level.additional_constraints == "info or warn"
    assert (left.floating_point_range, left.additional_constraints) == ([], "")


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        (Bounds(1.0, 2.0), "1 to 2"),
        (Bounds(most=2.0), "at most 2"),
        (Bounds(least=1.0), "at least 1"),
        (Bounds(), ""),
    ],
)
def test_bounds_have_words(bounds: Bounds, words: str) -> None:
    assert bounds.words == words
    if words:
        with pytest.raises(ConfigError, match=words):
            bounds.check(99.0 if bounds.most else 0.0)
        with pytest.raises(ConfigError, match=words):
            bounds.check(float("nan"))
    else:
        bounds.check("anything")


@pytest.mark.parametrize("name", ["", "a b", ".a", "a.", "a/b", "1"])
def test_a_name_is_words_with_dots(parameters: Parameters, name: str) -> None:
    with pytest.raises(ConfigError, match="a parameter is called speed"):
        parameters.declare(name, 1.0)


def test_a_name_is_taken_once_and_a_value_is_within_its_own_bounds(parameters: Parameters) -> None:
    with pytest.raises(ConfigError, match="gears is declared twice"):
        parameters.declare("gears", 1)
    with pytest.raises(ConfigError, match="expected at most 1, found 2"):
        parameters.declare("other", 2.0, "", Bounds(most=1.0))
    with pytest.raises(MessageError, match="a parameter is a truth value, number, text"):
        parameters.declare("other", {})  # type: ignore[type-var]


def test_they_are_asked_for_by_the_services_that_ros_has(parameters: Parameters) -> None:
    served: dict[str, str] = {}
    parameters.serve(lambda name, request, response, handler: served.update({name: request.ros_type}))
    assert served == {name: f"{ros_type}_Request" for name, ros_type in SERVICES.items()}
    assert served["set_parameters"] == "rcl_interfaces/srv/SetParameters_Request"


def test_a_program_makes_its_own_no_other_than_what_others_may(parameters: Parameters) -> None:
    speed = parameters.declare("speed", 1.0, "", Bounds(0.0, 2.0))
    speed.value = 1.5
    with pytest.raises(ConfigError, match=r"expected 0 to 2, found 7"):
        speed.value = 7.0
    assert speed.value == 1.5


def test_whoever_declared_it_may_refuse_with_a_plain_error(parameters: Parameters) -> None:
    def changed(value: float) -> None:
        raise ValueError("not on tuesdays")

    parameters.declare("heat", 1.0, changed=changed)
    assert set_to(parameters, "heat", 2.0) == "heat: not on tuesdays"
