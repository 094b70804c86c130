"""What rosbags says that a type is made of, in our own words."""

from typing import Any

from rosbags.interfaces import Nodetype

from zteleop.interfaces.msg_text import Type


def fields_of(store: Any, ros_type: str) -> list[tuple[str, Type]]:
    """Return the fields of a type as a store of rosbags has them."""
    told = [(name, _type(*kind)) for name, kind in store.fielddefs[ros_type][1]]
    return [] if [name for name, _ in told] == ["structure_needs_at_least_one_member"] else told


def _type(node: Nodetype, told: Any) -> Type:
    if node == Nodetype.NAME:
        return Type(told)
    if node == Nodetype.BASE:
        name, bound = told
        return Type(name, bound or None)
    item, length = told
    inner = _type(*item)
    if node == Nodetype.ARRAY:
        return inner._replace(array="fixed", length=length)
    return inner._replace(array="bounded" if length else "unbounded", length=length or None)
