"""What an expression about a message comes to: Python's syntax, worked out here, node by node.

It knows m, constants, comparisons, and, or, not, arithmetic of numbers, fields, items and five functions.
Nothing of it can take long, or need much memory.
"""

import ast
import operator
from collections.abc import Callable
from typing import Any

from zteleop.text.paths import step_into

_MOST_BITS = 2048
_MOST_DIGITS = 300
"""to round to; Python would compute 10 to the power of them"""


def _round(number: Any, digits: Any = None) -> Any:
    if digits is not None and not -_MOST_DIGITS <= digits <= _MOST_DIGITS:
        raise ValueError(f"a number is rounded to at most {_MOST_DIGITS} digits")
    return round(_number(number), digits)


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "len": len,
    "max": max,
    "min": min,
    "round": _round,
}
ARITHMETIC: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
SIGNS: dict[type[ast.AST], Callable[[Any], Any]] = {ast.USub: operator.neg, ast.UAdd: operator.pos}
COMPARISONS: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, container: item in container,
    ast.NotIn: lambda item, container: item not in container,
}


def value(node: ast.expr, m: Any) -> Any:
    """Return what a node comes to, for a message; raises what Python raises where it comes to nothing."""
    return _HOW[type(node)](node, m)


def _choose(node: ast.BoolOp, m: Any) -> Any:
    found: Any = None
    for part in node.values:
        found = value(part, m)
        if bool(found) is isinstance(node.op, ast.Or):
            return found
    return found


def _sign(node: ast.UnaryOp, m: Any) -> Any:
    found = value(node.operand, m)
    return not found if isinstance(node.op, ast.Not) else SIGNS[type(node.op)](_number(found))


def _calculate(node: ast.BinOp, m: Any) -> Any:
    left, right = _number(value(node.left, m)), _number(value(node.right, m))
    return ARITHMETIC[type(node.op)](left, right)


def _compare(node: ast.Compare, m: Any) -> Any:
    left, found = value(node.left, m), True
    for comparison, part in zip(node.ops, node.comparators, strict=True):
        right = value(part, m)
        found = COMPARISONS[type(comparison)](left, right)
        if not found:
            return found
        left = right
    return found


def _call(node: ast.Call, m: Any) -> Any:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    return FUNCTIONS[name](*(value(argument, m) for argument in node.args))


def _field(node: ast.Attribute, m: Any) -> Any:
    return _into(node.value, value(node.value, m), node.attr)


def _item(node: ast.Subscript, m: Any) -> Any:
    return _into(node.value, value(node.value, m), value(node.slice, m))


def _into(node: ast.expr, found: Any, step: Any) -> Any:
    if isinstance(step, bool) or not isinstance(step, str | int):
        raise TypeError(f"an item is taken by its number, not by a {type(step).__name__}")
    if isinstance(found, dict) and step in found:
        return found[step]
    return step_into(found, step, ast.unparse(node))


def _number(found: Any) -> Any:
    if not isinstance(found, int | float):
        raise TypeError(f"calculating needs numbers, not a {type(found).__name__}")
    if isinstance(found, int) and found.bit_length() > _MOST_BITS:
        raise OverflowError("a number grows too large")
    return found


_HOW: dict[type[ast.expr], Callable[[Any, Any], Any]] = {
    ast.Name: lambda node, m: m,
    ast.Constant: lambda node, m: node.value,
    ast.Tuple: lambda node, m: [value(item, m) for item in node.elts],
    ast.List: lambda node, m: [value(item, m) for item in node.elts],
    ast.BoolOp: _choose,
    ast.UnaryOp: _sign,
    ast.BinOp: _calculate,
    ast.Compare: _compare,
    ast.Call: _call,
    ast.Attribute: _field,
    ast.Subscript: _item,
}
NODES = (*_HOW, ast.And, ast.Or, ast.Not, ast.Load, *ARITHMETIC, *SIGNS, *COMPARISONS)
"""Whatever an expression may be made of."""
