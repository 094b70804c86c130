"""Which messages are wanted: an expression such as `m.twist.linear.x > 0.2`, of which nothing is executed."""

import ast
import warnings
from collections.abc import Iterator
from typing import Any

from zteleop.errors import MessageError
from zteleop.text import paths
from zteleop.text.expression import FUNCTIONS, NODES, value
from zteleop.text.paths import Path

LONGEST, DEEPEST = 1000, 50
_SHOWN = 80
_KNOWN = f"a filter has m, constants, comparisons, and, or, not, + - * / // %, {', '.join(FUNCTIONS)}"
_INSTEAD: dict[type[ast.AST], str] = {
    ast.BitAnd: "and, not &",
    ast.BitOr: "or, not |",
    ast.Invert: "not, not ~",
}
_SIGNS: dict[type[ast.AST], str] = {
    ast.Pow: "**",
    ast.LShift: "<<",
    ast.RShift: ">>",
    ast.BitXor: "^",
    ast.MatMult: "@",
}
_KINDS: dict[type, str] = {str: "text", bytes: "bytes", list: "a list", dict: "made of fields"}
_WORDS = {"true": "True", "false": "False", "null": "None"}


class Filter:
    """An expression that says of a message whether it is wanted; raises MessageError when it is none."""

    def __init__(self, text: str) -> None:
        self._tree = _parse(text)
        _bound(self._tree)
        _allow(self._tree)
        self.fields = [path for path in dict.fromkeys(_fields(self._tree)) if path]

    def check(self, example: Any, title: str) -> None:
        """Raise MessageError when it asks for a field that messages like the example do not have."""
        for path in self.fields:
            try:
                paths.check(example, path, title)
            except MessageError as error:
                raise MessageError(f"filter: {error}") from None

    def wants(self, values: Any) -> bool:
        """Say whether a message is wanted; raises MessageError when that cannot be worked out of it."""
        try:
            return bool(value(self._tree, values))
        except TypeError as error:
            reason = f"it compares, or calculates with, what does not go together: {self._kinds(values)}"
            raise MessageError(
                f"the filter does not suit a message: {reason if self.fields else error}"
            ) from None
        except (ValueError, ArithmeticError, RecursionError) as error:
            raise MessageError(f"the filter does not suit a message: {error}") from None

    def _kinds(self, values: Any) -> str:
        """Return what each field that it names is, in this message."""
        found = ((path, paths.value_at(values, path)) for path in self.fields)
        return ", ".join(f"m.{paths.named(path)} is {_kind(value)}" for path, value in found)


def _kind(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return str(value)
    return _KINDS.get(type(value), "a number")


def _parse(text: str) -> ast.expr:
    if len(text) > LONGEST:
        raise MessageError(f"a filter has at most {LONGEST} characters, found {len(text)}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        reason = error.msg if isinstance(error, SyntaxError) else str(error)
        raise MessageError(
            f"expected a filter such as 'm.twist.linear.x > 0.2', found {_short(text)!r}: {reason}"
        ) from None


def _bound(tree: ast.AST) -> None:
    """Raise MessageError for what is nested too deeply to be looked at, even to be refused."""
    level: list[ast.AST] = [tree]
    for _ in range(DEEPEST + 1):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
    if level:
        raise MessageError(f"a filter is nested at most {DEEPEST} deep")


def _allow(node: ast.AST) -> None:
    """Raise MessageError for whatever a filter may not be made of."""
    if refusal := _refusal(node):
        raise MessageError(refusal)
    for child in ast.iter_child_nodes(node):
        if not (isinstance(node, ast.Call) and child is node.func):
            _allow(child)


def _refusal(node: ast.AST) -> str:
    if instead := _INSTEAD.get(type(node)):
        return f"in a filter say {instead}"
    if isinstance(node, ast.Name):
        return "" if node.id == "m" else f"the filter has no {node.id!r}; {_meant(node.id)}"
    if isinstance(node, ast.Call):
        known = isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS and not node.keywords
        return "" if known else f"the filter cannot call {_shown(node.func)}; {_KNOWN}"
    odd = isinstance(node, ast.Constant) and not isinstance(node.value, bool | int | float | str | None)
    return f"the filter cannot have {_shown(node)}; {_KNOWN}" if odd or not isinstance(node, NODES) else ""


def _meant(name: str) -> str:
    if name in FUNCTIONS:
        return f"say {name}(...)"
    return f"did you mean {_WORDS.get(name, f'm.{name}')}?"


def _shown(node: ast.AST) -> str:
    return repr(_short(ast.unparse(node))) if isinstance(node, ast.expr) else _SIGNS.get(type(node), "that")


def _short(text: str) -> str:
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def _fields(node: ast.AST) -> Iterator[Path]:
    """Yield the paths of m that an expression names."""
    path = _path(node)
    if path is not None:
        yield path
        return
    for child in ast.iter_child_nodes(node):
        yield from _fields(child)


def _path(node: ast.AST) -> Path | None:
    if isinstance(node, ast.Name):
        return () if node.id == "m" else None
    if not isinstance(node, ast.Attribute | ast.Subscript):
        return None
    inner, step = _path(node.value), _step(node)
    return None if inner is None or step is None else (*inner, step)


def _step(node: ast.Attribute | ast.Subscript) -> str | int | None:
    if isinstance(node, ast.Attribute):
        return node.attr
    try:
        step = ast.literal_eval(node.slice)
    except ValueError:
        return None
    return step if isinstance(step, str | int) and not isinstance(step, bool) else None
