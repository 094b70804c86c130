"""From a JSON Schema that somebody sent to a Struct: types that were never imported here."""

from collections.abc import Mapping
from keyword import iskeyword
from typing import Annotated, Any, Literal, get_args, get_origin

import msgspec
from msgspec import Meta

from zteleop.errors import MessageError
from zteleop.interfaces.schema import ROS_TYPE
from zteleop.messages import Message
from zteleop.messages.message import field_types

MOST_PARTS, MOST_FIELDS, DEEPEST = 100, 1000, 20
MOST_VALUES = 20_000
"""that the shortest message of a type may hold: parts within parts, and items of a list, soon are many"""
_PLAIN = {"integer": int, "number": float, "string": str, "boolean": bool, "object": dict}
_BOUNDS = {
    "minimum": "ge",
    "maximum": "le",
    "exclusiveMinimum": "gt",
    "exclusiveMaximum": "lt",
    "minItems": "min_length",
    "maxItems": "max_length",
    "maxLength": "max_length",
}


def struct_of(schema: object, ros_type: str = "") -> type[Message]:
    """Return the message that a schema describes, called `ros_type` where it does not say so itself.

    Raises MessageError when it describes none.
    """
    if isinstance(schema, Mapping) and "$ref" not in schema and "properties" in schema:
        inner = schema.get("$defs", {})
        schema = {
            "$ref": "Message",
            "$defs": {**inner, "Message": schema} if isinstance(inner, Mapping) else {},
        }
    return _Builder(schema, ros_type).build()


class _Builder:
    def __init__(self, schema: object, ros_type: str) -> None:
        self._ros_type = ros_type
        found = schema if isinstance(schema, Mapping) else {}
        self._root = found.get("$ref")
        parts = found.get("$defs")
        self._parts: Mapping[str, Any] = parts if isinstance(parts, Mapping) else {}
        self._built: dict[str, type[Message]] = {}
        if len(self._parts) > MOST_PARTS:
            raise MessageError(f"expected a schema of at most {MOST_PARTS} parts, found {len(self._parts)}")

    def build(self) -> type[Message]:
        if not isinstance(self._root, str):
            raise MessageError("expected the JSON Schema of a message: $ref and $defs")
        try:
            found = self._part(self._root, 0)
            _check_size(found)
            found.zero()  # which whoever shows or writes one needs
            msgspec.json.Decoder(found)  # which looks at every annotation
            return found
        except MessageError:
            raise
        except (TypeError, ValueError, AttributeError, LookupError, ArithmeticError, RecursionError) as error:
            raise MessageError(f"not the schema of a message: {error}") from None

    def _part(self, reference: str, depth: int) -> type[Message]:
        name = reference.rpartition("/")[2]
        if name not in self._built:
            part = self._parts.get(name)
            if not isinstance(part, Mapping) or depth > DEEPEST:
                raise MessageError(f"a schema without {name!r}, or one within itself, is of no message")
            fields = part.get("properties", {})
            if not isinstance(fields, Mapping) or len(fields) > MOST_FIELDS:
                raise MessageError(f"expected at most {MOST_FIELDS} fields in {name}")
            typed = [(_identifier(field), self._type(its, depth + 1)) for field, its in fields.items()]
            default = self._ros_type if reference == self._root and self._ros_type else name
            says = {"ros_type": str(part.get(ROS_TYPE, default)), "__doc__": str(part.get("description", ""))}
            built: Any = msgspec.defstruct(
                _identifier(name), typed, bases=(Message,), namespace=says, module=__name__
            )
            self._built[name] = built
        return self._built[name]

    def _type(self, field: Mapping[str, Any], depth: int) -> Any:
        if "$ref" in field:
            return self._part(field["$ref"], depth)
        if "anyOf" in field:
            (kind,) = [option for option in field["anyOf"] if option.get("type") != "null"]
            return self._type(kind, depth) | None
        if "enum" in field:
            return Literal[tuple(field["enum"])]
        kind = self._plain(field, depth)
        if kind is bytes:  # a schema bounds its text in base64, which does not tell how many bytes that are
            return kind
        bounds = {_BOUNDS[key]: value for key, value in field.items() if key in _BOUNDS}
        return Annotated[kind, Meta(**bounds)] if bounds else kind

    def _plain(self, field: Mapping[str, Any], depth: int) -> Any:
        if depth > DEEPEST:
            raise MessageError(f"expected lists at most {DEEPEST} deep")
        if field.get("type") == "array":
            return list[self._type(field.get("items", {}), depth + 1)]  # type: ignore[misc]
        if field.get("contentEncoding") == "base64":
            return bytes
        return _PLAIN[field["type"]] if "type" in field else Any


def _check_size(kind: type[Message]) -> None:
    """Raise MessageError when the zero of a message would be a bomb."""
    sizes: dict[Any, int] = {}

    def size(field: Any) -> int:
        if field in sizes:
            return sizes[field]
        inner, *metas = get_args(field) if get_origin(field) is Annotated else (field,)
        if isinstance(inner, type) and issubclass(inner, Message):
            found = 1 + sum(map(size, field_types(inner).values()))
        else:
            least = max((m.min_length or 0 for m in metas if isinstance(m, Meta)), default=0)
            found = 1 + (least * size(get_args(inner)[0]) if get_origin(inner) is list else least)
        if found > MOST_VALUES:
            raise MessageError(f"a message of more than {MOST_VALUES} values is none")
        sizes[field] = found
        return found

    size(kind)


def _identifier(name: object) -> str:
    if not isinstance(name, str) or not name.isidentifier() or iskeyword(name) or name.startswith("__"):
        raise MessageError(f"{name!r:.80} cannot be the name of a field")
    if name == "ros_type" or hasattr(Message, name):  # which every message has for itself
        raise MessageError(f"{name!r} cannot be the name of a field")
    return name
