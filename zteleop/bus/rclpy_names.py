"""What a Node of rclpy has: whoever types it out of habit is told what it is called here."""

from typing import NoReturn

from zteleop.errors import ConfigError

HERE = {
    "create_publisher": "publisher(topic, type)",
    "create_subscription": "subscription(topic, type, handler), or @node.on(topic, type)",
    "create_timer": "every(period), before a function",
    "create_rate": "every(period), before a function",
    "create_service": "service(name, request, response, handler)",
    "create_client": "call(name, request, response)",
    "declare_parameter": "parameter(name, value)",
    "get_parameter": "parameter(name, value), whose .value it is",
    "get_logger": "log, with info, warn and error",
    "get_name": "name",
    "destroy_node": "close(), or the end of its `with`",
}
"""rclpy's name -> what to write after `node.`"""


def expect_function(function: object) -> None:
    """Raise ConfigError for what is none, such as the length of a queue behind a topic and its type."""
    if not callable(function):
        raise ConfigError(f"expected a function, found {function!r:.40}; how many are kept is depth=")


def miss(node: object, name: str) -> NoReturn:
    """Raise AttributeError with what to write in place of a name that a node has not."""
    if name in HERE:  # without the names by which Python would guess at another
        raise AttributeError(f"a Node has no {name}: here it is node.{HERE[name]} (docs/rclpy.md shows both)")
    raise AttributeError(f"a Node has no {name}", name=name, obj=node)
