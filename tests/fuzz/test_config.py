"""Any TOML: a config that a robot can be made of, or a ConfigError in one sentence."""

from collections.abc import Mapping
from typing import Any

from fuzz.reading import use
from hypothesis import example, given, settings
from hypothesis import strategies as st

from zteleop.config import Config, parse
from zteleop.errors import ConfigError
from zteleop.interfaces.schema import schema

SCHEMA = schema(Config, "config.toml")
SCALARS = st.one_of(
    st.booleans(),
    st.integers(),
    st.integers(-2, 20),
    st.floats(),
    st.floats(0, 3000),
    st.text(max_size=8),
    st.sampled_from(["[...]", "$.drive", "simulated", "pca9685", "client", "arrival", "archangel"]),
)
TABLES = st.dictionaries(st.text(max_size=5), SCALARS, max_size=2)
VALUES = st.one_of(SCALARS, st.lists(SCALARS, max_size=3), TABLES)
NAMES = st.sampled_from(["steering", "throttle", "left", "nav", "simulated", "pca9685", "a b", "[...]"])


def resolved(node: Mapping[str, Any]) -> Mapping[str, Any]:
    return SCHEMA["$defs"][node["$ref"].rpartition("/")[2]] if "$ref" in node else node


def like(node: Mapping[str, Any]) -> st.SearchStrategy[Any]:
    """Return values as the schema has them, or nearly."""
    node = resolved(node)
    if "anyOf" in node:
        return st.one_of(*[like(choice) for choice in node["anyOf"] if choice.get("type") != "null"])
    if "enum" in node:
        return st.sampled_from(node["enum"])
    kind = node.get("type")
    if kind == "object" and "properties" in node:
        required = set(node.get("required", ()))
        fields = {name: like(part) for name, part in node["properties"].items()}
        optional = {name: value for name, value in fields.items() if name not in required}
        exact = st.fixed_dictionaries({name: fields[name] for name in sorted(required)}, optional=optional)
        return nearly(exact)
    if kind == "object":
        inner = node.get("additionalProperties") or {}
        return st.dictionaries(NAMES, like(inner) if inner else VALUES, max_size=3)
    if kind == "array":
        return st.lists(like(node["items"]), max_size=2)
    if kind == "integer":
        return st.integers(node.get("minimum", -5) - 1, node.get("maximum", 100) + 1)
    if kind == "number":
        low = node.get("minimum", node.get("exclusiveMinimum", 0))
        high = node.get("maximum", node.get("exclusiveMaximum", 3000))
        return st.one_of(st.floats(low, high), st.sampled_from([low, high, float("nan"), float("inf")]))
    return {"boolean": st.booleans(), "string": st.text(max_size=8)}.get(str(kind), VALUES)


def nearly(exact: st.SearchStrategy[dict[str, Any]]) -> st.SearchStrategy[Any]:
    """Return the values, now and then with a key that is unknown or a value of another kind."""
    odd = st.dictionaries(st.text(max_size=6) | st.just("[...]"), VALUES, min_size=1, max_size=1)
    more = st.tuples(exact, odd).map(lambda both: both[0] | both[1])
    return st.integers(0, 9).flatmap(lambda dice: {8: more, 9: VALUES}.get(dice, exact))


def toml(value: Any) -> str:
    """Return a value as TOML writes it in a line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(key)} = {toml(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        return '"' + "".join(f"\\U{ord(char):08X}" for char in value) + '"'
    return repr(value)


def check(text: bytes) -> None:
    try:
        config = parse(text)
    except ConfigError:
        return
    use(config)


@settings(max_examples=400, deadline=None)
@given(st.one_of(st.binary(max_size=80), st.text(max_size=80).map(str.encode)))
@example(b"[" * 10_000)
@example(b"robot = '[...]'")
def test_any_text_is_a_config_or_a_config_error(text: bytes) -> None:
    check(text)


@settings(max_examples=400, deadline=None)
@given(like(SCHEMA).filter(lambda values: isinstance(values, dict)))
def test_any_values_under_the_real_keys_are_a_config_or_a_config_error(values: dict[str, Any]) -> None:
    check("\n".join(f"{toml(key)} = {toml(value)}" for key, value in values.items()).encode())
