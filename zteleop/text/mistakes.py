"""Everything that is wrong with values somebody wrote: where, what was expected, found, and is near."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, get_args, get_origin

import msgspec
from msgspec import inspect

from zteleop.errors import meant, nearest

Path = tuple[str, ...]
_LONGEST = 60
"""characters of a value that are shown"""


class Mistake(NamedTuple):
    """One of them, and the names that lead to it."""

    path: Path
    words: str


def mistakes(
    values: object, kind: Any, kinds: Mapping[Path, Any] | None = None, path: Path = ()
) -> Iterator[Mistake]:
    """Yield all mistakes of plain values that are to be of a kind; `kinds` says more of some places."""
    kinds = kinds or {}
    kind = kinds.get(path, kind)
    info = _bare(inspect.type_info(kind))
    if isinstance(info, inspect.UnionType) and _tagged(info):
        yield from _choice(values, info, kinds, path)
    elif isinstance(info, inspect.StructType):
        yield from _table(values, info.cls, kinds, path)
    elif isinstance(info, inspect.DictType) and isinstance(values, dict):
        for name, value in values.items():
            yield from mistakes(value, get_args(kind)[1], kinds, (*path, name))
    elif isinstance(info, inspect.ListType) and isinstance(values, list) and get_origin(kind) is list:
        for value in values:
            yield from mistakes(value, get_args(kind)[0], kinds, path)
    else:
        yield from _alone(values, kind, info, path)


def _choice(
    values: object, info: inspect.UnionType, kinds: Mapping[Path, Any], path: Path
) -> Iterator[Mistake]:
    """Look at a table of which one entry says what the others are."""
    choices = {one.tag: one for one in _tagged(info)}
    field = next(iter(choices.values())).tag_field or ""
    said = values.get(field) if isinstance(values, dict) else None
    if isinstance(values, dict) and isinstance(said, str) and said in choices:
        rest = {name: value for name, value in values.items() if name != field}
        yield from _table(rest, choices[said].cls, kinds, path, {field: said})
    elif said is None:
        yield Mistake(path, f"expected a table with {field} = {_or(choices)}, found {_found(values)}")
    else:
        yield Mistake((*path, field), f"expected {_or(choices)}, found {_found(said)}{_near(said, choices)}")


def _table(
    values: object, cls: Any, kinds: Mapping[Path, Any], path: Path, tag: Mapping[str, object] | None = None
) -> Iterator[Mistake]:
    """Look at every entry of a table, at what each does alone, and once all are right at the whole."""
    if not isinstance(values, dict):
        yield Mistake(path, f"expected a table, found {_found(values)}")
        return
    wrong: set[str] = set()
    for mistake in _entries(values, cls, kinds, path):
        wrong.update(mistake.path[len(path) : len(path) + 1] or [""])
        yield mistake
    if any(field.required for field in msgspec.structs.fields(cls)):
        alone = []
    else:
        alone = [(name, _refusal({name: values[name]}, cls)) for name in values if name not in wrong]
    for name, words in alone:
        if words:
            wrong.add(name)
            yield Mistake((*path, name), words)
    if not wrong:
        yield from _whole({**values, **(tag or {})}, cls, path)


def _entries(
    values: Mapping[str, object], cls: Any, kinds: Mapping[Path, Any], path: Path
) -> Iterator[Mistake]:
    fields = {field.encode_name: field for field in msgspec.structs.fields(cls)}
    for name in values:
        if name not in fields:
            meant_by_it = _elsewhere(name, fields, path) or nearest(name, fields)
            yield Mistake((*path, name), f"no such setting; {meant_by_it}")
    for name, field in fields.items():
        if name in values:
            yield from mistakes(values[name], field.type, kinds, (*path, name))
        elif field.required:
            yield Mistake(path, f"expected {name} as well")


def _elsewhere(name: str, fields: Mapping[str, msgspec.structs.FieldInfo], path: Path) -> str:
    """Ask, of a name that one of the tables below has, whether that is meant; nothing of others."""
    for outer, field in fields.items():
        inner = _bare(inspect.type_info(field.type))
        if isinstance(inner, inspect.StructType) and name in inner.cls.__struct_encode_fields__:
            return f"did you mean {'.'.join((*path, outer, name))}?"
    return ""


def _whole(values: dict[str, object], cls: Any, path: Path) -> Iterator[Mistake]:
    """Look at what entries must be to each other; what one of them does alone is its own mistake."""
    if words := _refusal(values, cls):
        alone = (name for name, value in values.items() if _refusal({name: value}, cls) == words)
        name = next(alone, None)
        yield Mistake(path if name is None else (*path, name), words)


def _alone(value: object, kind: Any, info: inspect.Type, path: Path) -> Iterator[Mistake]:
    if words := _refusal(value, kind):
        expected = _described(inspect.type_info(kind)) or _expected(info)
        told = f"expected {expected}, found {_found(value)}" if expected else words
        choices = info.values if isinstance(info, inspect.LiteralType) else ()
        yield Mistake(path, told + _near(value, choices))


def _refusal(value: object, kind: Any) -> str:
    try:
        msgspec.convert(value, kind)
    except (ValueError, RecursionError) as error:
        return str(error).partition(" - at `$")[0]
    return ""


def _bare(info: inspect.Type) -> inspect.Type:
    """Return a type without what is said about it, and without None: nobody can write that in a file."""
    while isinstance(info, inspect.Metadata):
        info = info.type
    if isinstance(info, inspect.UnionType):
        some = [one for one in info.types if not isinstance(one, inspect.NoneType)]
        return _bare(some[0]) if len(some) == 1 else info
    return info


def _tagged(info: inspect.UnionType) -> list[inspect.StructType]:
    return [one for one in info.types if isinstance(one, inspect.StructType) and one.tag_field]


def _expected(info: inspect.Type) -> str:
    """Return what may be written, as people say it; nothing where only the refusal knows."""
    if isinstance(info, inspect.BoolType):
        return "true or false"
    if isinstance(info, inspect.LiteralType):
        return _or(info.values)
    if isinstance(info, inspect.IntType | inspect.FloatType):
        return ("a whole number" if isinstance(info, inspect.IntType) else "a number") + _range(info)
    if isinstance(info, inspect.StrType):
        return "text" if info.pattern is None else ""
    if isinstance(info, inspect.ListType):
        inner = _expected(_bare(info.item_type))
        return f"a list, each of it {inner}" if inner else "a list"
    return "a table" if isinstance(info, inspect.DictType) else ""


def _described(info: inspect.Type) -> str:
    """Return what a type says of itself, where it does."""
    said = info.extra_json_schema if isinstance(info, inspect.Metadata) else None
    words = (said or {}).get("description", "")
    return str(words)


def _range(info: inspect.IntType | inspect.FloatType) -> str:
    if info.ge is not None and info.le is not None:
        return f" from {info.ge:g} to {info.le:g}"
    bounds = (("above", info.gt), ("at least", info.ge), ("below", info.lt), ("at most", info.le))
    said = [f"{word} {bound:g}" for word, bound in bounds if bound is not None]
    return " " + " and ".join(said) if said else ""


def _found(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict | list):
        return "a table" if isinstance(value, dict) else "a list"
    text = repr(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _near(value: object, choices: Iterable[object]) -> str:
    names = {str(choice) for choice in choices}
    question = meant(value, names) if isinstance(value, str) else ""
    return f"; {question}" if question else ""


def _or(choices: Iterable[object]) -> str:
    return " or ".join(map(_found, choices))
