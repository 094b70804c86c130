import random
from pathlib import Path
from typing import Any

import mcap_ros2.writer
import pytest
import rosbags.rosbag2
from rosbags.typesys import Stores, get_typestore
from unit.interfaces.cdr.values import anything
from unit.recording.files import Told, message, ours, recording

from zteleop.errors import RecordingError
from zteleop.interfaces import cdr, ros2msg
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Message
from zteleop.messages.message import plain
from zteleop.recording.form import values_of
from zteleop.recording.reading.bag import Bag


def later(number: int, topics: int) -> Told:
    topic, at, *rest = message(number, topics)
    return topic, at + 5, *rest


def test_the_files_of_a_folder_are_read_as_one(tmp_path: Path) -> None:
    (tmp_path / "b.mcap").write_bytes(recording(6))
    (tmp_path / "a.mcap").write_bytes(recording(6, told=later, topics=4))
    both = sorted([message(n) for n in range(6)] + [later(n, 4) for n in range(6)], key=lambda one: one[1])
    assert ours(tmp_path) == both
    with Bag(tmp_path) as bag:
        assert [(one.topic, one.messages) for one in bag.channels] == [
            ("/r/t0", 4),
            ("/r/t1", 4),
            ("/r/t2", 3),
            ("/r/t3", 1),
        ]
        assert (bag.begins, bag.ends, bag.count) == (1000, 1055, 12)
        assert [one.name for one in bag.attachments()] == ["graph.json", "graph.json"]
        assert bag.metadata() == {"zteleop": {"robots": "r"}}
        assert len([*bag.notes()]) == len([*bag.heads()]) == 2
        assert [kept.at for kept in bag.messages({"/r/t3"})] == [1035]


def test_what_is_wrong_is_told_of_each_file(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_bytes(recording())
    (tmp_path / "b.mcap").write_bytes(recording()[:-10])
    with Bag(tmp_path) as bag:
        assert bag.count == 24
        (words,) = bag.troubles
    assert words.startswith(f"{tmp_path / 'b.mcap'}: it has no end")


def test_a_recording_with_a_file_that_is_none_is_refused_and_no_file_stays_open(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_bytes(recording())
    (tmp_path / "b.mcap").write_bytes(b"hello")
    with pytest.raises(RecordingError, match="another kind of file"):  # and no ResourceWarning, an error here
        Bag(tmp_path)


NAMES = [
    "std_msgs/msg/String",
    "geometry_msgs/msg/TwistStamped",
    "sensor_msgs/msg/Joy",
    "tf2_msgs/msg/TFMessage",
]


def examples() -> list[Message]:
    dice = random.Random(7)
    return [anything(struct_of(name), dice) for name in NAMES for _ in range(3)]


def wanted() -> list[tuple[str, int, Any]]:
    return [(f"/{message.ros_type}", 10 + at, plain(message)) for at, message in enumerate(examples())]


def read(path: Path) -> list[tuple[str, int, Any]]:
    """Return the messages of a recording as its own schemas describe them."""
    with Bag(path) as bag:
        found = [
            (kept.channel.topic, kept.at, values_of(kept.channel.form)(kept.data)) for kept in bag.messages()
        ]
        assert bag.troubles == []
        return found


def test_a_bag_of_rosbags_is_read(tmp_path: Path) -> None:
    store, folder = get_typestore(Stores.ROS2_JAZZY), tmp_path / "bag"
    with rosbags.rosbag2.Writer(
        folder, version=9, storage_plugin=rosbags.rosbag2.StoragePlugin.MCAP
    ) as writer:
        topics = {name: writer.add_connection(f"/{name}", name, typestore=store) for name in NAMES}
        for at, message in enumerate(examples()):
            theirs = store.deserialize_cdr(cdr.encode(message), message.ros_type)
            data = store.serialize_cdr(theirs, message.ros_type)
            writer.write(topics[message.ros_type], 10 + at, data)
    assert read(folder) == wanted()
    assert read(folder / "bag.mcap") == wanted()


def test_a_file_of_mcap_ros2_support_is_read(tmp_path: Path) -> None:
    path = tmp_path / "theirs.mcap"
    with path.open("wb") as stream, mcap_ros2.writer.Writer(stream) as writer:
        for at, message in enumerate(examples()):
            schema = writer.register_msgdef(message.ros_type, ros2msg.text(type(message)))
            writer.write_message(f"/{message.ros_type}", schema, message, 10 + at, 10 + at)
    assert read(path) == wanted()
