"""The parameters of somebody's node, asked for and changed by its services."""

from collections.abc import Sequence
from typing import TypeVar

from zteleop.bus.names import Name
from zteleop.bus.service import ANSWERED_WITHIN, call
from zteleop.bus.session import Session
from zteleop.errors import BusError, nearest
from zteleop.messages import (
    DescribeParametersRequest,
    DescribeParametersResponse,
    GetParametersRequest,
    GetParametersResponse,
    ListParametersRequest,
    ListParametersResponse,
    Message,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetParametersRequest,
    SetParametersResponse,
    SetParametersResult,
)

R = TypeVar("R", bound=Message)


class NodeParameters:
    """Those of one node; each question raises BusError when it does not answer."""

    def __init__(self, session: Session, robot: str, node: str) -> None:
        self._session = session
        self._robot = robot
        self._node = node

    @property
    def name(self) -> str:
        """What others call it: `/archangel/actuator`."""
        return f"/{self._robot}/{self._node}"

    def names(self) -> list[str]:
        return self._ask("list", ListParametersRequest([], 0), ListParametersResponse).result.names

    def get(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return a value for each; raises BusError, with the nearest names, where there is none."""
        values = self._ask("get", GetParametersRequest([*names]), GetParametersResponse).values
        self._refuse_unknown(names, [value.type for value in values])
        return values

    def describe(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return what each may be; raises BusError likewise."""
        request = DescribeParametersRequest([*names])
        found = self._ask("describe", request, DescribeParametersResponse).descriptors
        self._refuse_unknown(names, [one.type for one in found])
        return found

    def set(self, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
        return self._ask("set", SetParametersRequest([*parameters]), SetParametersResponse).results

    def _refuse_unknown(self, names: Sequence[str], types: Sequence[int]) -> None:
        unknown = [name for name, kind in zip(names, types, strict=True) if kind == ParameterValue.NOT_SET]
        if unknown:
            raise BusError(
                f"{self.name} has no parameter {unknown[0]!r}; {nearest(unknown[0], self.names())}"
            )

    def _ask(self, verb: str, request: Message, response: type[R]) -> R:
        name = Name(self._robot, f"{self._node}/{verb}_parameters")
        return call(self._session, name, request, response, ANSWERED_WITHIN)
