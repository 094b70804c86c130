"""JSON Schema of messages and settings, for every other language and for editors."""

from typing import Any

import msgspec

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema(kind: type, title: str) -> dict[str, Any]:
    """Return the JSON Schema of a Struct."""
    (reference,), components = msgspec.json.schema_components([kind], ref_template="#/$defs/{name}")
    return {"$schema": DIALECT, "title": title, **reference, "$defs": components}


def text(kind: type, title: str) -> str:
    """Return the schema as it is kept in a file."""
    return (
        msgspec.json.format(msgspec.json.encode(schema(kind, title), order="sorted"), indent=2).decode()
        + "\n"
    )
