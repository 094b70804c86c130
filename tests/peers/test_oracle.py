"""Every type that rosbags has too, from texts of its own: hash by hash, and byte by byte both ways."""

import random

import pytest
from peers.test_cdr import same
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys import store as their_store
from unit.interfaces.cdr.values import TIMES, anything, kinds

from zteleop.interfaces import cdr
from zteleop.interfaces.distros import struct_for
from zteleop.interfaces.structs import struct_of
from zteleop.interfaces.type_hash import hash_of, hash_of_kind

STORES = {
    distro: get_typestore(getattr(Stores, f"ROS2_{distro.upper()}"))
    for distro in ("humble", "iron", "jazzy", "kilted", "lyrical")
}
SHARED = [
    (distro, kind.ros_type)
    for distro, store in STORES.items()
    for kind in kinds()
    if kind.ros_type in store.fielddefs
]
DIFFERENT = [
    (distro, ros_type)
    for distro, ros_type in SHARED
    if distro == "jazzy" or struct_for(ros_type, distro) is not struct_of(ros_type)
]
"""in Jazzy all types, and those that another distribution has otherwise"""
CHARS = {
    "std_msgs/msg/Char": "3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9",
    "service_msgs/msg/ServiceEventInfo": "41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45",
    "rmw_dds_common/msg/Gid": "ab6f21cfbb0a6dbb837161e1110c2051a2850ed9f9c53944d7115d9bcebedf71",
    "rmw_dds_common/msg/NodeEntitiesInfo": (
        "8ffef65ee2d088c63b1e8fcd31e800ba9fc8dbe0ee15ca60d1676de5218087a7"
    ),
    "rmw_dds_common/msg/ParticipantEntitiesInfo": (
        "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"
    ),
}
"""types with a char, which rosbags takes for that of an IDL file; in a .msg file it is a uint8"""


def test_there_are_enough_to_compare() -> None:
    counts = {distro: sum(shared == distro for shared, _ in SHARED) for distro in STORES}
    assert counts == {distro: len(STORES[distro].fielddefs) - strange(distro) for distro in STORES}


def strange(distro: str) -> int:
    """Return how many types rosbags has that do not come along here: those of its own recorder."""
    return sum(name.startswith("rosbag2_interfaces/") for name in STORES[distro].fielddefs)


@pytest.mark.parametrize("distro", STORES)
def test_every_hash_is_the_one_that_rosbags_has(distro: str) -> None:
    types = [ros_type for shared, ros_type in SHARED if shared == distro]
    store = STORES[distro]
    others = {name for name in types if hash_of_kind(struct_for(name, distro)) != store.hash_rihs01(name)}
    assert others == CHARS.keys() & types


@pytest.mark.parametrize("ros_type", CHARS)
def test_but_for_those_with_a_char_which_it_takes_for_another(
    ros_type: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert hash_of(ros_type) == f"RIHS01_{CHARS[ros_type]}"
    monkeypatch.setitem(their_store.TIDMAP, "char", their_store.TIDMAP["uint8"])
    assert STORES["jazzy"].hash_rihs01(ros_type) == f"RIHS01_{CHARS[ros_type]}"


@pytest.mark.parametrize("distro", STORES)
def test_every_message_is_the_same_bytes_both_ways(distro: str) -> None:
    for ros_type in (ros_type for its, ros_type in DIFFERENT if its == distro):
        _compare(distro, ros_type)


def _compare(distro: str, ros_type: str) -> None:
    kind, store, dice = struct_for(ros_type, distro), STORES[distro], random.Random(ros_type)
    for _ in range(TIMES):
        message = anything(kind, dice)
        data = cdr.encode(message)
        theirs = store.deserialize_cdr(data, ros_type)
        assert same(message, theirs)
        assert bytes(store.serialize_cdr(theirs, ros_type)) == data
        assert cdr.decode(bytes(store.serialize_cdr(theirs, ros_type, little_endian=False)), kind) == message
