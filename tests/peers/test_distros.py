"""What each distribution has otherwise, beside the stores of rosbags."""

import pytest
from peers.fields import fields_of
from rosbags.typesys import Stores, get_typestore
from unit.interfaces.cdr.values import kinds

from zteleop.interfaces.declared import declared
from zteleop.interfaces.distros import changed, struct_for

STORES = {
    "humble": Stores.ROS2_HUMBLE,
    "iron": Stores.ROS2_IRON,
    "jazzy": Stores.ROS2_JAZZY,
    "kilted": Stores.ROS2_KILTED,
    "lyrical": Stores.ROS2_LYRICAL,
}


@pytest.mark.parametrize("distro", STORES)
def test_types_are_what_the_distribution_has(distro: str) -> None:
    store = get_typestore(STORES[distro])
    shared = [kind.ros_type for kind in kinds() if kind.ros_type in store.fielddefs]
    assert len(shared) > 140
    for ros_type in shared:
        ours = [(field.name, field.type) for field in declared(struct_for(ros_type, distro)).fields]
        assert ours == fields_of(store, ros_type)


@pytest.mark.parametrize("distro", STORES)
def test_only_those_that_differ_are_others(distro: str) -> None:
    theirs = get_typestore(STORES[distro])
    differ = {
        kind.ros_type
        for kind in kinds()
        if kind.ros_type in theirs.fielddefs
        and [(field.name, field.type) for field in declared(kind).fields] != fields_of(theirs, kind.ros_type)
    }
    assert differ == changed(distro).keys()
