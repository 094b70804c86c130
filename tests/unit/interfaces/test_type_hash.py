import json
from hashlib import sha256
from pathlib import Path
from subprocess import run
from sys import executable
from typing import Any

import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, library
from zteleop.interfaces.library import add_folder
from zteleop.interfaces.structs import struct_of
from zteleop.interfaces.type_description import description_of, description_of_kind
from zteleop.interfaces.type_hash import hash_of, hash_of_kind, rihs01, struct_described
from zteleop.messages import MESSAGES, DriveStatus, Twist
from zteleop.messages.message import plain

GOLDEN = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Int16MultiArray": "b58810e8e5b90fb19a5062469eb8409f5ab11a446d60de7157a1457e52a076ce",
    "std_msgs/msg/MultiArrayLayout": "4c66e6f78e740ac103a94cf63259f968e48c617e7699e829b63c21a5cb50dac6",
    "std_msgs/msg/MultiArrayDimension": "5e773a60a4c7fc8a54985f307c7837aa2994252a126c301957a24e31282c9cbe",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "std_msgs/msg/Bool": "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
    "std_msgs/msg/Float64": "705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a",
    "geometry_msgs/msg/Vector3": "cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "geometry_msgs/msg/TwistStamped": "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64",
    "sensor_msgs/msg/Joy": "0d356c79cad3401e35ffeb75a96a96e08be3ef896b8b83841d73e890989372c5",
    "sensor_msgs/msg/CompressedImage": "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a",
    "sensor_msgs/msg/BatteryState": "4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741",
    "sensor_msgs/msg/Imu": "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
    "sensor_msgs/msg/LaserScan": "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
    "sensor_msgs/msg/Range": "b42b62562e93cbfe9d42b82fe5994dfa3d63d7d5c90a317981703f7388adff3a",
    "sensor_msgs/msg/JointState": "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
    "nav_msgs/msg/Odometry": "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "builtin_interfaces/msg/Time": "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197",
    "builtin_interfaces/msg/Duration": "e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b",
    "rcl_interfaces/msg/Log": "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac",
    "irobot_create_msgs/msg/Button": "538cfb25a327f40d560bc800c7b2944b51248765effbd0dfa7821f77c20fec7d",
    "irobot_create_msgs/msg/InterfaceButtons": (
        "832c0f48b1eb89aeebb16920a506abae8706934497ce4b2e17c3da94b4558916"
    ),
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "std_srvs/srv/Trigger": "eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f",
    "example_interfaces/srv/SetBool": "a69782e5631b12e15c8e218410de1685bbf13e382718295adad14037a24afbe8",
    "std_srvs/srv/SetBool": "abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a",
    "std_srvs/srv/Empty": "5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19",
    "action_msgs/msg/GoalStatusArray": "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "example_interfaces/action/Fibonacci": "9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51",
    "example_interfaces/action/Fibonacci_SendGoal": (
        "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557"
    ),
    "example_interfaces/action/Fibonacci_GetResult": (
        "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57"
    ),
    "example_interfaces/action/Fibonacci_FeedbackMessage": (
        "c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2"
    ),
    "rcl_interfaces/msg/ParameterEvent": "043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204",
    "rcl_interfaces/srv/DescribeParameters": (
        "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff"
    ),
    "rcl_interfaces/srv/GetParameterTypes": (
        "da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca"
    ),
    "rcl_interfaces/srv/GetParameters": "bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc",
    "rcl_interfaces/srv/ListParameters": "3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
    "rcl_interfaces/srv/SetParameters": "56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0",
    "rcl_interfaces/srv/SetParametersAtomically": (
        "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd"
    ),
    "type_description_interfaces/srv/GetTypeDescription": (
        "69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"
    ),
}
"""as ROS's own tools print them, or two programs that others wrote"""


@pytest.mark.parametrize("ros_type", GOLDEN)
def test_a_hash_is_what_ros_2_prints(ros_type: str) -> None:
    assert hash_of(ros_type) == f"RIHS01_{GOLDEN[ros_type]}"


@pytest.mark.parametrize("ros_type", [ros_type for ros_type in GOLDEN if "/msg/" in ros_type])
def test_a_struct_has_the_hash_of_its_type(ros_type: str) -> None:
    assert hash_of_kind(struct_of(ros_type)) == f"RIHS01_{GOLDEN[ros_type]}"


def test_every_type_and_everything_that_comes_of_it_has_a_hash_of_its_own() -> None:
    every = [
        f"{package}/{kind}/{leaf}{end}"
        for package in library.packages()
        for kind, ends in {
            "msg": [""],
            "srv": ["", "_Request", "_Response", "_Event"],
            "action": ["", "_Goal", "_SendGoal", "_SendGoal_Request", "_GetResult_Event", "_FeedbackMessage"],
        }.items()
        for leaf in library.types(package, kind)  # type: ignore[arg-type]
        for end in ends
    ]
    found = [hash_of(ros_type) for ros_type in every]
    assert len(set(found)) == len(found) > 300
    assert all(len(one) == len("RIHS01_") + 64 for one in found)


@pytest.mark.parametrize(
    "ros_type", ["irobot_create_msgs/action/Dock_SendGoal_Request", "std_srvs/srv/SetBool_Event"]
)
def test_a_struct_of_what_comes_of_an_interface_has_its_hash_too(ros_type: str) -> None:
    assert hash_of_kind(struct_of(ros_type)) == hash_of(ros_type)


def test_the_text_that_is_hashed_is_to_the_letter_this() -> None:
    field = (
        '{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "string_capacity": 0, '
        '"nested_type_name": "{}"}}}}'
    )
    text = (
        '{"type_description": {"type_name": "unique_identifier_msgs/msg/UUID", "fields": ['
        + field.format("uuid", 3 + 48, 16, "")
        + ']}, "referenced_type_descriptions": []}'
    )
    wanted = sha256(text.encode()).hexdigest()
    assert hash_of("unique_identifier_msgs/msg/UUID") == f"RIHS01_{wanted}"
    assert json.loads(text)


def test_our_own_messages_have_one_where_ros_has_a_word_for_each_part() -> None:
    for kind in MESSAGES.values():
        try:
            cdr.encoder(kind)
        except MessageError:
            with pytest.raises(MessageError):
                hash_of_kind(kind)
        else:
            assert hash_of_kind(kind).startswith("RIHS01_")
    assert hash_of_kind(DriveStatus) != hash_of_kind(Twist)


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(library, "_theirs", {})

    def make(name: str, text: str) -> str:
        for cached in (library.definition, library.described, library._parse, hash_of):
            cached.cache_clear()
        path = tmp_path / "own_msgs" / "msg" / f"{name}.msg"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        add_folder(tmp_path)
        return f"own_msgs/msg/{name}"

    return make


def test_comments_constants_and_defaults_do_not_count(own: Any) -> None:
    bare = hash_of(own("One", "float64 x\nint8 y\n"))
    assert hash_of(own("One", "# of it\nint8 K=3\nfloat64 x 1.5 # far\nint8 y -3\n")) == bare
    assert hash_of(own("One", "int8 y\nfloat64 x\n")) != bare
    assert hash_of(own("One", "float64 x\nint8 z\n")) != bare
    assert hash_of(own("One", "float64 x\nuint8 y\n")) != bare


def test_a_char_counts_as_a_uint8_and_a_byte_does_not(own: Any) -> None:
    assert hash_of(own("One", "char c\nchar[3] d")) == hash_of(own("One", "uint8 c\nuint8[3] d"))
    assert hash_of(own("One", "byte c")) != hash_of(own("One", "uint8 c"))


def test_an_empty_type_is_the_one_with_the_field_that_stands_for_none(own: Any) -> None:
    assert hash_of(own("One", "")) == hash_of(own("One", "uint8 structure_needs_at_least_one_member"))


def test_of_an_unknown_type_the_nearest_are_told() -> None:
    with pytest.raises(MessageError, match="did you mean geometry_msgs/msg/Twist"):
        hash_of("geometry_msgs/msg/Twst")


def test_a_description_with_its_hash_is_a_struct() -> None:
    description = description_of("sensor_msgs/msg/Joy")
    kind = struct_described(description, hash_of("sensor_msgs/msg/Joy"))
    assert kind.ros_type == "sensor_msgs/msg/Joy"
    assert hash_of_kind(kind) == hash_of("sensor_msgs/msg/Joy")
    joy = struct_of("sensor_msgs/msg/Joy").zero()
    joy.axes = [0.5]  # type: ignore[attr-defined]
    assert plain(cdr.decode(cdr.encode(joy), kind)) == plain(joy)


def test_a_half_of_a_service_is_found_in_its_description() -> None:
    whole = "std_srvs/srv/SetBool"
    found = struct_described(description_of(whole), hash_of(whole), f"{whole}_Request")
    assert found is MESSAGES[f"{whole}_Request"]
    with pytest.raises(MessageError, match="does not tell what x/srv/Y_Request is"):
        struct_described(description_of(whole), hash_of(whole), "x/srv/Y_Request")


def test_a_description_with_another_hash_is_refused() -> None:
    description = description_of("sensor_msgs/msg/Joy")
    with pytest.raises(
        MessageError, match=r"expected the description with the hash RIHS01_\w+, found RIHS01_"
    ):
        struct_described(description, hash_of("sensor_msgs/msg/Imu"))
    description.type_description.fields[0].name = "head"  # type: ignore[attr-defined]
    with pytest.raises(MessageError, match="expected the description with the hash"):
        struct_described(description, hash_of("sensor_msgs/msg/Joy"))


def test_a_description_travels_and_keeps_its_hash() -> None:
    for description in (description_of("std_srvs/srv/SetBool"), description_of_kind(Twist)):
        kind = type(description)
        assert rihs01(cdr.decode(cdr.encode(description), kind)) == rihs01(description)


def test_zteleop_starts_without_it() -> None:
    program = "import sys, zteleop, zteleop.bus; print([name for name in sys.modules if 'type_hash' in name])"
    found = run([executable, "-c", program], capture_output=True, text=True, check=True)
    assert found.stdout == "[]\n"
