"""What the source of a message says about it and its fields, for people."""

import ast
import inspect
from itertools import pairwise
from textwrap import dedent

from zteleop.messages import Message


def type_comment(kind: type[Message]) -> str:
    """Return what a message's class says of itself; empty where it says nothing."""
    own = kind.__dict__.get("__doc__") or ""
    return inspect.cleandoc(own)


def field_comments(kind: type[Message]) -> dict[str, str]:
    """Return the text below each field that has one; none for a type that has come over the bus."""
    try:
        (tree,) = ast.parse(dedent(inspect.getsource(kind))).body
    except (OSError, TypeError, SyntaxError, ValueError):
        return {}
    body = tree.body if isinstance(tree, ast.ClassDef) else []
    return {
        field.target.id: inspect.cleandoc(text.value.value)
        for field, text in pairwise(body)
        if isinstance(field, ast.AnnAssign)
        and isinstance(field.target, ast.Name)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
        and isinstance(text.value.value, str)
    }
