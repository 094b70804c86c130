"""What a Node of rclpy has: whoever types it out of habit is told what it is called here."""

from typing import NoReturn

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


def miss(node: object, name: str) -> NoReturn:
    """Raise AttributeError with what to write in place of a name that a node has not."""
    meant = f": here it is node.{HERE[name]} (docs/rclpy.md shows both)" if name in HERE else ""
    raise AttributeError(f"a {type(node).__name__} has no {name}{meant}", name=name, obj=node)
