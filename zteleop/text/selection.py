"""What of a topic's messages somebody wants to see: of which type, which of them, which fields."""

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from zteleop.errors import MessageError
from zteleop.messages import MESSAGES, Message, is_called, message_type
from zteleop.messages.message import field_types, plain
from zteleop.text import paths
from zteleop.text.paths import Path

if TYPE_CHECKING:
    from zteleop.text.filter import Filter


class Selection(NamedTuple):
    """Asked for in words, and not yet held against any message."""

    type_name: str | None = None
    fields: tuple[Path, ...] = ()
    filter: "Filter | None" = None

    def check_types(self, kinds: Iterable[type[Message]], topic: str) -> None:
        """Raise MessageError when no message of a topic's types, or of the type asked for, can suit."""
        named = _known(self.type_name) if self.type_name else []  # raises for a name that is a mistake
        kinds = kinds or named
        refusals = []
        for kind in kinds:
            try:
                self.check(plain(kind.zero()), kind.ros_type, topic)
            except MessageError as error:
                refusals.append(error)
            else:
                return
        if refusals:
            raise refusals[0]

    def check(self, example: Any, ros_type: str, topic: str) -> None:
        """Raise MessageError when messages like this one are not what was asked for."""
        if self.type_name and not is_called(ros_type, self.type_name):
            raise MessageError(f"{topic} carries {ros_type}, not {self.type_name}; say that type, or none")
        title = ros_type.rpartition("/")[2] or "the message"
        for path in self.fields:
            paths.check(example, path, title)
        if self.filter:
            self.filter.check(example, title)

    def wants(self, values: Any) -> bool:
        return self.filter is None or self.filter.wants(values)

    def parts(self, values: Any) -> Iterator[tuple[str, Any]]:
        """Yield each field that was asked for, by its name; without any, the whole message without a name."""
        if not self.fields:
            yield "", values
        for path in self.fields:
            yield paths.named(path), paths.value_at(values, path)


def kind_at(ros_type: str, name: str, known: Mapping[str, type[Message]] = MESSAGES) -> Any:
    """Return the type of a field of a message, where it is known."""
    kind: Any = known.get(ros_type)
    for step in paths.parse(name) if name else ():
        is_message = isinstance(kind, type) and issubclass(kind, Message)
        kind = field_types(kind).get(str(step)) if is_message else None
    return kind


def _known(name: str) -> list[type[Message]]:
    """Return the message called so; none for what only others know; raises MessageError for a mistake."""
    package, slash, _ = name.partition("/")
    if slash and not any(ros_type.startswith(f"{package}/") for ros_type in MESSAGES):
        return []
    return [message_type(name)]
