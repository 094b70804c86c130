"""What can be read of a settings file that is not right, for verbs that must not fail for a typo."""

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from copy import deepcopy
from itertools import islice
from pathlib import Path
from typing import Any

import msgspec

from zteleop import config
from zteleop.config import Config
from zteleop.drivers import DRIVERS, settings_kind
from zteleop.errors import ConfigError
from zteleop.text.mistakes import mistakes

Values = dict[str, Any]
_UNREADABLE = (msgspec.DecodeError, ValueError, RecursionError)
ROUNDS = 3
"""of mending: one value put right may show that another is wrong"""
_TABLES = re.compile(rb"^(?=[ \t]*\[)", re.MULTILINE)


def salvage(path: Path | None = None) -> tuple[Config, str]:
    """Return the settings of a file, and what is wrong with it; what cannot be read is as built in."""
    try:
        return config.load(path), ""
    except ConfigError as error:
        first, *more = str(error).splitlines()
        wrong = f"{first} (and {len(more)} more, says zteleop check)" if more else first
        values = _read(_text(path))
        mended = None
        with suppress(ValueError, TypeError, LookupError, RecursionError):  # the rest is tried all the same
            mended = _mended(values)
        return mended or _convert(_sound(values)) or Config(), wrong


def unknown_driver(path: Path | None = None) -> str:
    """Return what a file calls its driver where there is no such driver; nothing where all is well."""
    driver = _read(_text(path)).get("driver", "simulated")
    return "" if driver in DRIVERS else str(driver)


def _text(path: Path | None) -> bytes:
    try:
        with (path or config.found() or Path()).open("rb") as file:
            return file.read(config.LONGEST)
    except OSError:
        return b""


def _read(text: bytes) -> Values:
    """Return the values of every table that is TOML, and of the others those of each line that is."""
    values: Values = {}
    for table in _TABLES.split(text):
        for part in [table] if _decode(table) is not None else _lines(table):
            _merge(values, _decode(part) or {})
    return values


def _lines(table: bytes) -> Iterator[bytes]:
    head, *lines = table.splitlines()
    if not head.lstrip().startswith(b"["):
        yield head
        head = b""
    for line in lines:
        yield head + b"\n" + line


def _decode(text: bytes) -> Values | None:
    try:
        values: Values = msgspec.toml.decode(text)
    except _UNREADABLE:
        return None
    return values


def _merge(values: Values, more: Values) -> None:
    for name, value in more.items():
        if isinstance(value, dict) and isinstance(values.get(name), dict):
            _merge(values[name], value)
        else:
            values[name] = value


def _mended(values: Values) -> Config | None:
    """Return the settings with what is built in for each value that is wrong, where that is enough."""
    mended, usual = deepcopy(values), msgspec.to_builtins(Config())
    kinds: dict[tuple[str, ...], Any] = {("drivers", driver): settings_kind(driver) for driver in DRIVERS}
    for _ in range(ROUNDS):
        if settings := _convert(mended):
            return settings
        for path, _ in list(islice(mistakes(mended, Config, kinds), config.MOST)):
            _put_back(mended, usual, path)
    return _convert(mended)


def _put_back(values: Values, usual: Any, path: Sequence[str]) -> None:
    """Put what is built in at a place, or take away what has no place there."""
    *tables, name = path or ("",)
    for table in tables:
        usual = usual.get(table, {}) if isinstance(usual, dict) else {}
        inner = values.get(table)
        if not isinstance(inner, dict):
            return
        values = inner
    if isinstance(usual, dict) and name in usual:
        values[name] = deepcopy(usual[name])
    else:
        values.pop(name, None)


def _sound(values: Values, *path: str) -> Values:
    """Return the values that can be obeyed alone; of a table that cannot, those of its entries that can."""
    found: Values = {}
    for name, value in values.items():
        lone: Values = {name: value}
        for part in reversed(path):
            lone = {part: lone}
        if _convert(lone):
            found[name] = value
        elif isinstance(value, dict) and (inner := _sound(value, *path, name)):
            found[name] = inner
    return found


def _convert(values: Values) -> Config | None:
    try:
        return msgspec.convert(values, Config)
    except (msgspec.ValidationError, ConfigError):
        return None
