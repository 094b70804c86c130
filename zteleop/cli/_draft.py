"""A message as somebody typed it: `stamp: now` and `header: auto` mean the moment at which it is said."""

from typing import Any, Generic, TypeVar

from zteleop.bus import clock
from zteleop.interfaces.defaults import with_defaults
from zteleop.interfaces.values import fill
from zteleop.messages import Message
from zteleop.messages.message import plain
from zteleop.text import yaml_text

M = TypeVar("M", bound=Message)
NOW, AUTO = "now", "auto"


class Draft(Generic[M]):
    """Makes messages of one text; raises MessageError at once when it is none."""

    def __init__(self, kind: type[M], text: str) -> None:
        self._kind = kind
        values = yaml_text.load(text)
        if isinstance(values, str) and ":" in values:  # in quotes, as `interface proto` prints it
            values = yaml_text.load(values)
        self._values = values
        self._message = self._filled({"sec": 0, "nanosec": 0})
        self._has_date = dated(self._values, None) != self._values

    def make(self) -> M:
        """Return the message, of this moment where it says so."""
        if self._has_date:
            self._message = self._filled(plain(clock.stamp()))
        return self._message

    def _filled(self, now: Any) -> M:
        return fill(self._kind, with_defaults(self._kind, dated(self._values, now)))


def dated(values: Any, now: Any) -> Any:
    """Return values in which each `stamp: now`, and each `header: auto`, has a stamp."""
    if isinstance(values, list):
        return [dated(value, now) for value in values]
    if not isinstance(values, dict):
        return values
    found = {key: dated(value, now) for key, value in values.items()}
    if found.get("stamp") == NOW:
        found["stamp"] = now
    if found.get("header") == AUTO:
        found["header"] = {"stamp": now}
    return found
