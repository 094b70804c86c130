"""Every error zteleop raises on purpose, each with the builtin a careless `except` would name.

    ZteleopError
    ├── ConfigError  (ValueError)   a setting or an argument cannot be obeyed
    ├── MessageError (ValueError)   bytes are not the message their topic promises
    ├── BusError     (OSError)      the bus cannot be joined, or nobody answers
    ├── DeviceError  (OSError)      a chip, bus or terminal is missing, busy or silent
    └── RecordingError (OSError)    a file holds no recording, or none can be kept in it

Each message says what was expected, what was found and what to do.
"""

from collections.abc import Iterable

_SHOWN = 20
"""names that are told when none is near"""


class ZteleopError(Exception):
    """The command line prints these in one sentence, without a traceback."""

    exit_code = 1


class ConfigError(ZteleopError, ValueError):
    """A setting or an argument cannot be obeyed."""


class MessageError(ZteleopError, ValueError):
    """Bytes or fields are not the message their topic promises."""


class BusError(ZteleopError, OSError):
    """The bus cannot be joined, or nobody answers on it."""


class DeviceError(ZteleopError, OSError):
    """A chip, an I2C bus or a terminal is missing, busy or silent."""


class RecordingError(ZteleopError, OSError):
    """A file holds no recording, or none can be kept in it."""


def nearest(name: str, known: Iterable[str]) -> str:
    """Return what somebody may have meant, as the end of a sentence: the nearest names, else all."""
    names = sorted(set(known))
    if question := meant(name, names):
        return question
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"known: {', '.join(names[:_SHOWN]) or 'none'}{more}"


def meant(name: str, known: Iterable[str]) -> str:
    """Return the question after the nearest names; nothing where none is near."""
    from difflib import get_close_matches

    names = sorted(set(known))
    ends = get_close_matches(_end(name), {_end(one) for one in names}, 3, 0.6)
    alike = [one for one in names if _end(one) in ends]  # whatever stands before it
    alike = alike or [  # such as interface/buttons, for interface_buttons
        one for one in names if not _end(name) or get_close_matches(_end(name), [_end(one)], 1, 0.5)
    ]
    near = get_close_matches(name, alike, 3, 0.0 if ends else 0.6)
    return f"did you mean {' or '.join(near)}?" if near else ""


def _end(name: str) -> str:
    return name.rpartition("/")[2]


def install(extra: str) -> str:
    """Return the command that adds an extra to this very installation, which may be of a folder."""
    import json
    import sys
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import unquote, urlsplit

    try:
        origin = json.loads(distribution("zteleop").read_text("direct_url.json") or "{}")
    except (PackageNotFoundError, ValueError):
        origin = {}
    url = urlsplit(str(origin.get("url", "")))
    if url.scheme != "file":
        return f"pip install 'zteleop[{extra}]'"
    editable = "-e " * bool(origin.get("dir_info", {}).get("editable"))
    return f"{sys.executable} -m pip install {editable}'{unquote(url.path)}[{extra}]'"
