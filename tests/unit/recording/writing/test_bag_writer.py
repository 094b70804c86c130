"""Files as BagWriter writes them, read by the mcap library, mcap-ros2-support, rosbags and by ourselves."""

import errno
from collections.abc import Callable
from pathlib import Path
from struct import unpack

import pytest
from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader

from zteleop.errors import RecordingError
from zteleop.messages import CompressedImage, DriveStatus, Header, Message, Odometry, Time, TwistStamped
from zteleop.messages.message import plain
from zteleop.recording.form import Form, form_of, unknown, writer_of
from zteleop.recording.reading.bag import Bag
from zteleop.recording.writing.bag_writer import BagWriter
from zteleop.recording.writing.chunk import Compression

NOW = 1_800_000_000_000_000_000
HEADER = Header(Time(1_700_000_000, 5), "base_link")


def odometry() -> Odometry:
    message = Odometry.zero()
    message.header, message.pose.pose.position.x = HEADER, 1.25
    message.pose.covariance[7] = 0.5
    return message


def drive_status() -> DriveStatus:
    message = DriveStatus.zero()
    message.state, message.why, message.operator = "driving", "keyboard drives: ü", "abc"
    return message


SAID: dict[str, Message] = {
    "/r/odom": odometry(),
    "/r/drive_status": drive_status(),
    "/r/cmd_vel/keyboard": TwistStamped.zero(),
    "/r/camera/image/compressed": CompressedImage(HEADER, "jpeg", bytes(range(256)) * 200),
}


def write(path: Path, compression: Compression = "zstd", times: int = 3) -> None:
    """Say everything some times, a ns apart."""
    with BagWriter(path, compression) as bag:
        for number in range(times * len(SAID)):
            topic, message = list(SAID.items())[number % len(SAID)]
            kind = type(message)
            channel = bag.add(topic, form_of(kind), {"robot": "r"})
            bag.write(channel, NOW + number, NOW - number, number, writer_of(kind)(message))


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "drive.mcap"


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_ros_2_support_of_mcap_reads_equal_values(path: Path, compression: Compression) -> None:
    write(path, compression)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        found = list(reader.iter_decoded_messages())
    assert len(found) == 3 * len(SAID)
    for number, (_, channel, message, decoded) in enumerate(found):
        assert (message.log_time, message.publish_time, message.sequence) == (
            NOW + number,
            NOW - number,
            number,
        )
        assert_equal(plain(SAID[channel.topic]), decoded)


def assert_equal(ours: object, theirs: object) -> None:
    """Hold plain values against objects with attributes."""
    if isinstance(ours, dict):
        for name, value in ours.items():
            assert_equal(value, getattr(theirs, name))
    elif isinstance(ours, list):
        assert len(ours) == len(theirs)  # type: ignore[arg-type]
        for one, other in zip(ours, theirs, strict=True):  # type: ignore[call-overload]
            assert_equal(one, other)
    else:
        assert (bytes(theirs) if isinstance(ours, bytes) else theirs) == ours  # type: ignore[call-overload]


def test_rosbags_reads_equal_values(path: Path) -> None:
    write(path)
    with AnyReader([path]) as reader:
        found = list(reader.messages())
        assert [at for _, at, _ in found] == [NOW + number for number in range(len(found))]
        for connection, _, data in found:
            assert_equal(plain(SAID[connection.topic]), reader.deserialize(data, connection.msgtype))


def test_we_read_what_was_written(path: Path) -> None:
    write(path)
    with Bag(path) as bag:
        assert {channel.topic: channel.messages for channel in bag.channels} == dict.fromkeys(SAID, 3)
        assert (bag.count, bag.begins, bag.ends) == (12, NOW, NOW + 11)
        assert bag.troubles == []
        assert {channel.metadata["robot"] for channel in bag.channels} == {"r"}
        kept = next(bag.messages(["/r/odom"]))
    assert kept.data == writer_of(Odometry)(odometry())


def test_the_end_tells_what_the_mcap_library_counts(path: Path) -> None:
    with BagWriter(path, chunk_size=100) as bag:
        channel = bag.add("/r/odom", form_of(Odometry))
        bag.describe("zteleop", {"version": "1"})
        for number in range(10):
            bag.write(channel, NOW + 9 - number, NOW, number, bytes(50))
        bag.attach("graph.json", "application/json", NOW, b"{}")
        assert bag.messages == 10
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        told = summary.statistics
        assert (told.message_count, told.chunk_count, told.schema_count, told.channel_count) == (10, 6, 1, 1)
        assert (told.message_start_time, told.message_end_time) == (NOW, NOW + 9)
        assert (told.attachment_count, told.metadata_count) == (1, 1)
        assert told.channel_message_counts == {channel: 10}
        assert [m.log_time for _, _, m in reader.iter_messages()] == [NOW + n for n in range(10)]
        some = reader.iter_messages(starting_at=NOW + 3, ending_before=NOW + 5)
        assert [m.sequence for _, _, m in some] == [6, 5]
        assert [one.data for one in reader.iter_attachments()] == [b"{}"]
        assert [one.metadata for one in reader.iter_metadata()] == [{"version": "1"}]
        file.seek(0)
        assert type(list(StreamReader(file).records)[-1]).__name__ == "Footer"


def test_what_the_end_says_of_places_is_there(path: Path) -> None:
    """Readers that go by the index of messages, or by groups of the end, as those in C++ do."""
    with BagWriter(path, "none", chunk_size=300) as bag:
        channels = [bag.add(topic, form_of(Odometry)) for topic in ("/r/a", "/r/b")]
        for number in range(20):
            bag.write(channels[number % 2], NOW + number, NOW, number, bytes(50))
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
        assert summary is not None
        found = []
        for chunk in summary.chunk_indexes:
            for number, offset in chunk.message_index_offsets.items():
                file.seek(offset + 9)
                index = records.MessageIndex.read(ReadDataStream(file))
                assert index.channel_id == number
                found += [at for at, _ in index.records]
        assert sorted(found) == [NOW + number for number in range(20)]
        file.seek(-37 + 9, 2)
        told, offsets = unpack("<QQ", file.read(16))
        file.seek(offsets)
        groups = [file.read(26) for _ in range(4)]
        for group in groups:
            _, _, code, start, length = unpack("<BQBQQ", group)
            assert told <= start < start + length <= offsets
            file.seek(start)
            assert file.read(1)[0] == code


def test_a_topic_may_have_several_forms_and_a_type_that_nobody_explains(path: Path) -> None:
    odd = unknown("application/json;odd_msgs/msg/Odd")
    with BagWriter(path) as bag:
        numbers = [bag.add("/r/odom", form) for form in (form_of(Odometry), odd, form_of(Odometry))]
        assert numbers == [1, 2, 1]
        bag.write(2, NOW, NOW, 1, b'{"odd": 1}')
    with Bag(path) as bag_:
        assert [(channel.form, channel.messages) for channel in bag_.channels] == [
            (form_of(Odometry), 0),
            (odd, 1),
        ]
    with AnyReader([path]) as reader:
        assert [data for _, _, data in reader.messages()] == [b'{"odd": 1}']


def test_thousands_of_channels(path: Path) -> None:
    form = form_of(TwistStamped)
    data = writer_of(TwistStamped)(TwistStamped.zero())
    with BagWriter(path) as bag:
        for number in range(3_000):
            bag.write(bag.add(f"/r/topic_{number}", form), NOW + number, NOW, 0, data)
    with Bag(path) as found:
        assert len(found.channels) == found.count == 3_000
    with Reader(path) as reader:
        assert len(reader.connections) == sum(1 for _ in reader.messages()) == 3_000


def test_more_channels_than_a_file_can_have_are_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("zteleop.recording.writing.bag_writer.CHANNELS", 2)
    with BagWriter(path) as bag:
        for topic in "ab":
            bag.add(topic, Form("", "json"))
        with pytest.raises(RecordingError, match=r"drive.mcap has 2 channels, and can have no more"):
            bag.add("c", Form("", "json"))


def test_a_file_that_is_there_is_not_overwritten(path: Path) -> None:
    path.write_text("somebody's")
    with pytest.raises(RecordingError, match="is there already, and is not overwritten; say another name"):
        BagWriter(path)
    assert path.read_text() == "somebody's"


def test_a_place_that_is_none_is_told(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"cannot write .*/none/x.mcap: No such file"):
        BagWriter(tmp_path / "none" / "x.mcap")


def test_a_time_that_is_none_is_told(path: Path) -> None:
    with BagWriter(path) as bag, pytest.raises(RecordingError, match="found one that is none"):
        bag.write(bag.add("/r/odom", Form("", "json")), -1, NOW, 0, b"")


def test_what_was_flushed_can_be_read_without_the_rest(path: Path) -> None:
    bag = BagWriter(path)
    channel = bag.add("/r/odom", form_of(Odometry))
    for number in range(5):
        bag.write(channel, NOW + number, NOW, number, writer_of(Odometry)(odometry()))
    bag.flush()
    bag.write(channel, NOW + 5, NOW, 5, bytes(100_000))
    with path.open("rb") as file:
        cut = path.with_name("cut.mcap")
        cut.write_bytes(file.read())
    with Bag(cut) as found:
        assert [kept.sequence for kept in found.messages()] == [0, 1, 2, 3, 4]
    bag.close()


class Disk:
    """A file on a disk that takes so many bytes."""

    def __init__(self, room: int) -> None:
        self.room, self.data, self.closed = room, b"", False

    def write(self, data: bytes) -> None:
        if len(self.data) + len(data) > self.room:
            raise OSError(errno.ENOSPC, "No space left on device")
        self.data += data

    def flush(self) -> None:
        """Nothing waits."""

    def close(self) -> None:
        self.closed = True


REFUSED: dict[str, Callable[[BagWriter], object]] = {
    "flush": lambda bag: bag.flush(),
    "attach": lambda bag: bag.attach("a", "b", NOW, bytes(1000)),
    "describe": lambda bag: bag.describe("a", {"b": "c" * 1000}),
    "close": lambda bag: bag.close(),
}


@pytest.mark.parametrize("act", REFUSED.values(), ids=REFUSED)
def test_a_disk_that_is_full_is_told_again_and_again(act: Callable[[BagWriter], object]) -> None:
    disk = Disk(100)
    bag = BagWriter(Path("drive.mcap"), "none", disk)
    bag.write(bag.add("/r/odom", Form("", "json")), NOW, NOW, 0, bytes(1000))
    for again in (act, lambda bag: bag.flush()):
        with pytest.raises(RecordingError, match=r"^cannot write drive.mcap: No space left on device$"):
            again(bag)
    assert disk.closed
    bag.close()
    assert bag.refused == "cannot write drive.mcap: No space left on device"


def test_a_chunk_that_is_full_is_written_without_being_asked() -> None:
    disk = Disk(10_000)
    bag = BagWriter(Path("drive.mcap"), "none", disk, chunk_size=1000)
    channel = bag.add("/r/odom", Form("", "json"))
    before = len(disk.data)
    bag.write(channel, NOW, NOW, 0, bytes(500))
    assert (len(disk.data), bag.waiting > 500) == (before, True)
    bag.write(channel, NOW, NOW, 0, bytes(500))
    assert len(disk.data) == bag.size > 1000
    assert bag.waiting == 0
