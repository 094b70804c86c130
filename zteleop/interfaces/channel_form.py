"""The form of messages, told in the words of MCAP; whoever only passes it on needs no more than this."""

from typing import NamedTuple


class Form(NamedTuple):
    """What a channel, of a file or of a bridge, says of its messages, in the words of MCAP."""

    type: str
    encoding: str
    """of the messages: cdr, json, or whatever came"""
    schema_encoding: str = ""
    """ros2msg, jsonschema, or empty where nothing is known"""
    schema: bytes = b""
