"""Quantities with their units, as people type them: 0.2m/s, 30deg/s, 50cm, 500ms."""

import re
from math import isfinite, pi
from typing import Literal, NamedTuple

from zteleop.errors import ConfigError, nearest

Dimension = Literal["length", "speed", "turn", "angle", "time"]


class Kind(NamedTuple):
    """What a dimension is called, how it is typed, and its units in SI."""

    called: str
    example: str
    units: dict[str, float]


DEGREE = pi / 180
KINDS: dict[Dimension, Kind] = {
    "length": Kind("a length", "50cm", {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0, "in": 0.0254}),
    "speed": Kind("a speed", "0.2m/s", {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "km/h": 1 / 3.6}),
    "turn": Kind("a turning speed", "30deg/s", {"rad/s": 1.0, "deg/s": DEGREE, "°/s": DEGREE}),
    "angle": Kind("an angle", "90deg", {"rad": 1.0, "deg": DEGREE, "°": DEGREE}),
    "time": Kind("a time", "2s", {"s": 1.0, "ms": 0.001, "m": 60.0, "min": 60.0, "h": 3600.0}),
}
_NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
_SHOWN = 40


def quantity(text: str, dimension: Dimension) -> float:
    """Return in SI units what a text such as `20cm/s` says; a bare number is in SI units already.

    Raises ConfigError when it is none, not finite, or of another dimension.
    """
    kind = KINDS[dimension]
    wanted = f"expected {kind.called} such as {kind.example}, found {_shown(text)}"
    number = _NUMBER.match(text.strip())
    if number is None:
        lone = any(text.strip() in other.units for other in KINDS.values())
        raise ConfigError(f"{wanted}; write number and unit together" if lone else wanted)
    unit = text.strip()[number.end() :].strip()
    if unit and unit not in kind.units:
        raise ConfigError(f"{wanted}{_why(unit, kind)}")
    value = float(number[0]) * (kind.units[unit] if unit else 1.0)
    if not isfinite(value):
        raise ConfigError(f"{wanted}, which is too large for a number")
    return value


def _why(unit: str, kind: Kind) -> str:
    """Return what a unit is instead, as the end of a sentence."""
    for other in KINDS.values():
        if unit in other.units:
            return f", which is {other.called}"
    if unit.startswith(","):
        return "; a decimal point is a point"
    if "," in unit:
        return "; that is two of them: write a space"
    return f"; no unit {_shown(unit)}, {nearest(unit, kind.units)}"


def _shown(text: str) -> str:
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}...")
