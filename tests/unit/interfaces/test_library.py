from pathlib import Path
from subprocess import run
from sys import executable

import pytest

from zteleop.errors import ConfigError, MessageError
from zteleop.interfaces import library
from zteleop.interfaces.library import add_folder, definition, packages, types
from zteleop.interfaces.msg_text import PARTS, PLAIN, Constant, Type
from zteleop.messages import MESSAGES

ALL = [
    f"{package}/{kind}/{leaf}{end}"
    for package in packages()
    for kind, ends in PARTS.items()
    for leaf in types(package, kind)  # type: ignore[arg-type]
    for end in ends
]


@pytest.fixture(autouse=True)
def _alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(library, "_theirs", {})
    definition.cache_clear()


def put(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def names(ros_type: str) -> list[str]:
    return [field.name for field in definition(ros_type).fields]


def test_it_has_the_packages_that_programs_import() -> None:
    assert set(packages()) >= {
        "action_msgs",
        "builtin_interfaces",
        "example_interfaces",
        "geometry_msgs",
        "irobot_create_msgs",
        "nav_msgs",
        "rcl_interfaces",
        "rosgraph_msgs",
        "rospy_tutorials",
        "sensor_msgs",
        "std_msgs",
        "std_srvs",
        "tf2_msgs",
        "unique_identifier_msgs",
    }
    assert len(ALL) > 250


def test_every_definition_can_be_read_and_whatever_is_in_it_is_there() -> None:
    for ros_type in ALL:
        found = definition(ros_type)
        assert found.ros_type == ros_type
        for field in found.fields:
            assert field.type.name in PLAIN or definition(field.type.name), ros_type


def test_no_file_of_it_has_a_comment() -> None:
    files = [path for path in library.BUNDLED.rglob("*.*") if path.is_file()]
    assert {path.suffix for path in files} == {f".{kind}" for kind in PARTS}
    assert not [path for path in files if "#" in path.read_text()]


@pytest.mark.parametrize(
    ("ros_type", "fields"),
    [
        ("geometry_msgs/msg/Twist", ["linear", "angular"]),
        ("std_msgs/msg/Empty", []),
        ("std_srvs/srv/SetBool_Request", ["data"]),
        ("std_srvs/srv/SetBool_Response", ["success", "message"]),
        ("irobot_create_msgs/action/RotateAngle_Goal", ["angle", "max_rotation_speed"]),
        ("rospy_tutorials/srv/AddTwoInts_Response", ["sum"]),
    ],
)
def test_a_definition_is_found_by_its_ros_type(ros_type: str, fields: list[str]) -> None:
    assert names(ros_type) == fields


def test_a_definition_has_its_constants() -> None:
    assert definition("rcl_interfaces/msg/Log").constants[-1] == Constant(Type("uint8"), "FATAL", 50)


@pytest.mark.parametrize(
    ("ros_type", "why"),
    [
        (
            "geometry_msgs/msg/Twst",
            "no interface 'geometry_msgs/msg/Twst'; did you mean geometry_msgs/msg/Twist",
        ),
        ("geometry_msgs/Twist", "did you mean geometry_msgs/msg/Twist"),
        ("geometry_mgs/msg/Twist", "no package 'geometry_mgs' of interfaces; did you mean geometry_msgs"),
        ("../../etc/msg/Twist", "no package '..' of interfaces"),
        ("std_msgs/../msg/Bool", "no interface"),
        ("std_srvs/srv/SetBool", "ask for std_srvs/srv/SetBool_Request or std_srvs/srv/SetBool_Response"),
        ("std_msgs/msg/Bool_Request", "no interface"),
        ("Twist", "expected a type such as geometry_msgs/msg/Twist, found 'Twist'"),
    ],
)
def test_an_unknown_type_is_told_the_nearest(ros_type: str, why: str) -> None:
    with pytest.raises(MessageError) as error:
        definition(ros_type)
    assert why in str(error.value)


def test_types_are_names_without_their_package() -> None:
    assert types("std_srvs", "srv") == ["Empty", "SetBool", "Trigger"]
    assert types("std_srvs", "msg") == []
    assert types("garden_msgs", "msg") == []
    assert types("..", "msg") == []


def test_users_own_folder_is_as_in_a_workspace(tmp_path: Path) -> None:
    put(tmp_path, "src/garden_msgs/msg/Soil.msg", "float64 wetness")
    put(tmp_path, "src/garden_msgs/srv/Water.srv", "float64 litres\n---\nbool done")
    put(tmp_path, "src/deep/other_msgs/action/Grow.action", "---\n---\nfloat64 height")
    add_folder(tmp_path)
    assert names("garden_msgs/msg/Soil") == ["wetness"]
    assert names("garden_msgs/srv/Water_Response") == ["done"]
    assert names("other_msgs/action/Grow_Feedback") == ["height"]
    assert types("garden_msgs", "msg") == ["Soil"]
    assert {"garden_msgs", "other_msgs", "std_msgs"} <= set(packages())


def test_a_folder_may_be_the_package_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put(tmp_path, "garden_msgs/msg/Soil.msg", "float64 wetness")
    monkeypatch.chdir(tmp_path / "garden_msgs" / "msg")
    add_folder(Path())
    assert names("garden_msgs/msg/Soil") == ["wetness"]


def test_a_package_is_called_what_it_says(tmp_path: Path) -> None:
    put(tmp_path, "garden_msgs-main/msg/Soil.msg", "float64 wetness")
    put(tmp_path, "garden_msgs-main/package.xml", "<package><name> garden_msgs </name></package>")
    add_folder(tmp_path)
    assert names("garden_msgs/msg/Soil") == ["wetness"]


def test_what_a_workspace_has_built_is_not_looked_at(tmp_path: Path) -> None:
    put(tmp_path, "src/deep/er/garden_msgs/msg/Soil.msg", "float64 wetness")
    put(tmp_path, "install/garden_msgs/msg/Soil.msg", "float64 stale")
    put(tmp_path, "install/COLCON_IGNORE", "")
    put(tmp_path, ".git/garden_msgs/msg/Soil.msg", "float64 hidden")
    add_folder(tmp_path)
    assert names("garden_msgs/msg/Soil") == ["wetness"]


def test_of_two_with_one_name_the_less_deep_counts(tmp_path: Path) -> None:
    put(tmp_path, "a/old/garden_msgs/msg/Soil.msg", "float64 old")
    put(tmp_path, "z/garden_msgs/msg/Soil.msg", "float64 new")
    add_folder(tmp_path)
    assert names("garden_msgs/msg/Soil") == ["new"]


def test_a_link_to_a_folder_around_it_ends(tmp_path: Path) -> None:
    put(tmp_path, "garden_msgs/msg/Soil.msg", "float64 wetness")
    (tmp_path / "garden_msgs" / "again").symlink_to(tmp_path)
    add_folder(tmp_path)
    assert names("garden_msgs/msg/Soil") == ["wetness"]


def test_the_folder_added_last_wins_and_over_what_comes_along(tmp_path: Path) -> None:
    put(tmp_path, "one/geometry_msgs/msg/Accel.msg", "float64 one")
    put(tmp_path, "one/garden_msgs/msg/Soil.msg", "float64 one")
    put(tmp_path, "two/garden_msgs/msg/Soil.msg", "float64 two")
    add_folder(tmp_path / "one")
    add_folder(tmp_path / "two")
    assert names("geometry_msgs/msg/Accel") == ["one"]
    assert names("garden_msgs/msg/Soil") == ["two"]


def test_but_not_over_a_type_that_is_a_struct_of_our_own(tmp_path: Path) -> None:
    put(tmp_path, "geometry_msgs/msg/Twist.msg", "float64 theirs")
    put(tmp_path, "std_srvs/srv/SetBool.srv", "float64 theirs\n---\n")
    add_folder(tmp_path)
    assert names("geometry_msgs/msg/Twist") == [*MESSAGES["geometry_msgs/msg/Twist"].__struct_fields__]
    assert names("std_srvs/srv/SetBool_Request") == ["data"]


def test_what_was_asked_for_stays_as_it_was(tmp_path: Path) -> None:
    before = definition("geometry_msgs/msg/Accel")
    put(tmp_path, "geometry_msgs/msg/Accel.msg", "float64 theirs")
    add_folder(tmp_path)
    assert definition("geometry_msgs/msg/Accel") is before


def test_files_of_other_names_are_not_of_it(tmp_path: Path) -> None:
    put(tmp_path, "garden_msgs/msg/Soil.msg", "")
    put(tmp_path, "garden_msgs/msg/Soil.idl", "")
    put(tmp_path, "garden_msgs/msg/my soil.msg", "")
    put(tmp_path, "garden_msgs/srv/Soil.msg", "")
    put(tmp_path, "my garden/msg/Soil.msg", "")
    add_folder(tmp_path)
    assert [*library._theirs] == ["garden_msgs/msg/Soil"]


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("nowhere", "expected a folder of .msg, .srv and .action files, found none at"),
        ("file", "expected a folder of .msg, .srv and .action files, found none at"),
        ("empty", "expected files such as my_msgs/msg/Name.msg below"),
    ],
)
def test_a_folder_without_interfaces_is_one_sentence(tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "file").touch()
    (tmp_path / "empty").mkdir()
    with pytest.raises(ConfigError, match=why):
        add_folder(tmp_path / name)


def test_a_file_that_declares_nothing_is_an_error_when_it_is_asked_for(tmp_path: Path) -> None:
    put(tmp_path, "garden_msgs/msg/Soil.msg", "float64")
    put(tmp_path, "garden_msgs/msg/Bytes.msg", "").write_bytes(b"\xff\xff")
    gone = put(tmp_path, "garden_msgs/msg/Gone.msg", "")
    add_folder(tmp_path)
    gone.unlink()
    with pytest.raises(MessageError, match="garden_msgs/msg/Soil, line 1: expected a type and a name"):
        definition("garden_msgs/msg/Soil")
    with pytest.raises(MessageError, match=r"cannot read .*Bytes.msg, which declares garden_msgs/msg/Bytes"):
        definition("garden_msgs/msg/Bytes")
    with pytest.raises(MessageError, match=r"cannot read .*Gone.msg"):
        definition("garden_msgs/msg/Gone")


def test_importing_it_reads_none_of_it() -> None:
    program = """
import sys
opened = []
looks = ("open", "os.scandir", "os.listdir")
sys.addaudithook(lambda event, what: event in looks and opened.append(str(what[0])))
import zteleop.interfaces.structs
assert opened
print([path for path in opened if "definitions" in path])
"""
    found = run([executable, "-c", program], capture_output=True, text=True, check=True)
    assert found.stdout == "[]\n"
