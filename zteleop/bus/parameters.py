"""Parameters: values of a node that others may read and change while it runs, as ROS's nodes have them."""

from collections.abc import Callable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

from zteleop.errors import ConfigError, ZteleopError, nearest
from zteleop.interfaces.parameters import Value, fit, from_python, kind_of, to_python, type_words
from zteleop.messages import (
    DescribeParametersRequest,
    DescribeParametersResponse,
    FloatingPointRange,
    GetParametersRequest,
    GetParametersResponse,
    IntegerRange,
    ListParametersRequest,
    ListParametersResponse,
    ListParametersResult,
    Message,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetParametersRequest,
    SetParametersResponse,
    SetParametersResult,
    service_type,
)

V = TypeVar("V", bound=Value)
Serve = Callable[[str, type[Message], type[Message], Callable[[Any], Message]], None]
Say = Callable[[str], object]


SERVICES = {
    f"{verb}_parameters": f"rcl_interfaces/srv/{verb.title()}Parameters"
    for verb in ("list", "get", "set", "describe")
}
"""of a node, below its own name, and their types"""


class Bounds(NamedTuple):
    """What a parameter may be, besides of its type."""

    least: float | None = None
    most: float | None = None
    choices: Sequence[str] = ()

    @property
    def words(self) -> str:
        """What may be set, to follow `expected`; nothing where anything may."""
        if self.choices:
            return " or ".join(self.choices)
        if self.least is not None and self.most is not None:
            return f"{self.least:g} to {self.most:g}"
        if self.most is not None:
            return f"at most {self.most:g}"
        return "" if self.least is None else f"at least {self.least:g}"

    def check(self, value: Any) -> None:
        """Raise ConfigError for a value that may not be set."""
        below = self.least is not None and not value >= self.least
        above = self.most is not None and not value <= self.most
        if below or above or (self.choices and value not in self.choices):
            raise ConfigError(f"expected {self.words}, found {value}")


ANY = Bounds()


class Declared(Generic[V]):
    """One parameter."""

    def __init__(
        self,
        name: str,
        value: V,
        description: str,
        bounds: Bounds,
        changed: Callable[[V], object] | None,
    ) -> None:
        self.name = name
        self._value = value
        self.description = description
        self.bounds = bounds
        self._kind = kind_of(value)
        self._changed = changed

    @property
    def value(self) -> V:
        """What it is now; raises ConfigError when a program makes it what it may not be."""
        return self._value

    @value.setter
    def value(self, value: V) -> None:
        self.bounds.check(value)
        self._value = value

    def set(self, value: Any) -> None:
        """Take another value.

        Raises MessageError or ConfigError for one that it cannot be, or that whoever declared it refuses.
        """
        found: V = fit(value, self._kind)
        self.bounds.check(found)
        if self._changed:
            self._changed(found)
        self.value = found

    @property
    def descriptor(self) -> ParameterDescriptor:
        """What it may be, as ROS says it."""
        described = ParameterDescriptor.zero()
        described.name, described.type = self.name, self._kind
        described.description = self.description
        least, most = self.bounds.least, self.bounds.most
        if least is None or most is None:
            described.additional_constraints = self.bounds.words
        elif self._kind == ParameterValue.INTEGER:
            described.integer_range = [IntegerRange(int(least), int(most), 1)]
        else:
            described.floating_point_range = [FloatingPointRange(least, most, 0.0)]
        return described


class Parameters:
    """Those of one node; a change is told in its log."""

    def __init__(self, say: Say) -> None:
        self._say = say
        self._declared: dict[str, Declared[Any]] = {}

    def declare(
        self,
        name: str,
        value: V,
        description: str = "",
        bounds: Bounds = ANY,
        changed: Callable[[V], object] | None = None,
    ) -> Declared[V]:
        """Return a new parameter; raises ConfigError where there is one already, or it cannot be so."""
        if name in self._declared:
            raise ConfigError(f"parameter {name} is declared twice")
        if not name or not all(part.isidentifier() for part in name.split(".")):
            raise ConfigError(f"a parameter is called speed, or limits.speed; found {name!r}")
        try:
            bounds.check(value)
        except ConfigError as error:
            raise ConfigError(f"parameter {name}: {error}") from None
        self._declared[name] = Declared(name, value, description, bounds, changed)
        return self._declared[name]

    def serve(self, serve: Serve) -> None:
        """Answer what others ask of them."""
        answers: tuple[Callable[[Any], Message], ...] = (self.list, self.get, self.set, self.describe)
        for (name, ros_type), answer in zip(SERVICES.items(), answers, strict=True):
            serve(name, *service_type(ros_type), answer)

    def list(self, request: ListParametersRequest) -> ListParametersResponse:
        """Return the names below some prefixes, or all."""
        found = sorted(name for name in self._declared if _is_below(name, request.prefixes, request.depth))
        prefixes = sorted({name.rpartition(".")[0] for name in found if "." in name})
        return ListParametersResponse(ListParametersResult(found, prefixes))

    def get(self, request: GetParametersRequest) -> GetParametersResponse:
        """Return values, NOT_SET for what there is none of."""
        known = self._declared
        return GetParametersResponse(
            [
                from_python(known[name].value) if name in known else ParameterValue.zero()
                for name in request.names
            ]
        )

    def set(self, request: SetParametersRequest) -> SetParametersResponse:
        """Change one after another; each is told whether it was."""
        return SetParametersResponse([self._set(parameter) for parameter in request.parameters])

    def describe(self, request: DescribeParametersRequest) -> DescribeParametersResponse:
        """Return what each may be; of no type what there is none of."""
        known = self._declared
        return DescribeParametersResponse(
            [
                known[name].descriptor if name in known else ParameterDescriptor.zero()
                for name in request.names
            ]
        )

    def _set(self, parameter: Parameter) -> SetParametersResult:
        declared = self._declared.get(parameter.name)
        if declared is None:
            near = nearest(parameter.name, self._declared)
            return SetParametersResult(False, f"no parameter {parameter.name!r}; {near}")
        before = declared.value
        try:
            declared.set(_value_of(parameter))
        except (ZteleopError, ValueError) as error:  # the latter of whoever declared it
            return SetParametersResult(False, f"{parameter.name}: {error}")
        if declared.value != before:
            self._say(f"{parameter.name} is {declared.value} now, and was {before}")
        return SetParametersResult(True, "")


def _value_of(parameter: Parameter) -> Any:
    value = to_python(parameter.value)
    if value is None:
        raise ConfigError(f"expected a value, found {type_words(parameter.value.type)}")
    return value


def _is_below(name: str, prefixes: Sequence[str], depth: int) -> bool:
    for prefix in prefixes or [""]:
        rest = name.removeprefix(f"{prefix}.") if prefix else name
        if (not prefix or rest != name) and (not depth or rest.count(".") < depth):
            return True
    return False
