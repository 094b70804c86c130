import pytest

from zteleop.cli.interface_list import names_of


@pytest.mark.parametrize(
    ("package", "kind", "there"),
    [
        ("sensor_msgs", "msg", "sensor_msgs/msg/LaserScan"),
        ("std_msgs", "msg", "std_msgs/msg/Float64"),
        ("zteleop_msgs", "msg", "zteleop_msgs/msg/DriveStatus"),
        ("std_srvs", "srv", "std_srvs/srv/SetBool"),
        ("irobot_create_msgs", "action", "irobot_create_msgs/action/Dock"),
    ],
)
def test_whatever_can_be_shown_is_listed(package: str, kind: str, there: str) -> None:
    names = names_of(package, kind)  # type: ignore[arg-type]
    assert there in names
    assert names == sorted(set(names))
    assert not [name for name in names if name.endswith(("_Request", "_Response"))]
