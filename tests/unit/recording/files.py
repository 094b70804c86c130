"""MCAP files for tests, written by the mcap library, whole or broken on purpose."""

from collections.abc import Callable, Iterator, Mapping
from io import BytesIO
from pathlib import Path
from struct import pack, unpack_from
from types import MappingProxyType
from typing import NamedTuple

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from rosbags.rosbag2.storage_mcap import McapReader

from zteleop.recording.reading.bag import Bag

NONE, ZSTD, LZ4 = CompressionType.NONE, CompressionType.ZSTD, CompressionType.LZ4
STRING = b"string data\n"
HEAD = 9
"""bytes before what a record says"""
CHUNK, MESSAGE, MESSAGE_INDEX, CHUNK_INDEX, ATTACHMENT, STATISTICS, DATA_END = 6, 5, 7, 8, 9, 11, 15
Told = tuple[str, int, int, int, bytes]
"""of a message: its topic, when it arrived, when it was said, its sequence and its data"""


class Record(NamedTuple):
    kind: int
    at: int
    end: int


def cdr(text: str) -> bytes:
    data = text.encode() + b"\0"
    return b"\0\1\0\0" + pack("<I", len(data)) + data


def message(number: int, topics: int = 3) -> Told:
    """Return what is told of a message of a file that `recording` makes."""
    text = chr(97 + number % 26) * (number % 5 * 4)
    return f"/r/t{number % topics}", 1000 + number * 10, 900 + number * 10, number, cdr(text)


def recording(
    messages: int = 12,
    compression: CompressionType = ZSTD,
    chunk: int = 150,
    topics: int = 3,
    told: Callable[[int, int], Told] = message,
    attachment: bytes = b'{"a": 1}',
    about: Mapping[str, str] = MappingProxyType({"robots": "r"}),
    **options: bool,
) -> bytes:
    """Return a file of some topics, with an attachment and a word about it."""
    file = BytesIO()
    writer = Writer(file, chunk, compression, **options)  # type: ignore[arg-type]
    writer.start("ros2", "tests")
    writer.add_metadata("zteleop", dict(about))
    schema = writer.register_schema("std_msgs/msg/String", "ros2msg", STRING)
    qos = {"offered_qos_profiles": ""}
    numbers = {f"/r/t{n}": writer.register_channel(f"/r/t{n}", "cdr", schema, qos) for n in range(topics)}
    for number in range(messages):
        topic, at, published, sequence, data = told(number, topics)
        writer.add_message(numbers[topic], at, data, published, sequence)
    writer.add_attachment(5, 6, "graph.json", "application/json", attachment)
    writer.finish()
    return file.getvalue()


def records(data: bytes) -> Iterator[Record]:
    """Yield the records of a whole file."""
    at = 8
    while at < len(data) - 8:
        kind, length = unpack_from("<BQ", data, at)
        yield Record(kind, at, at + HEAD + length)
        at += HEAD + length


def complete(data: bytes) -> list[tuple[int, int]]:
    """Return where each part of a file with messages ends, and how many messages there are up to there."""
    found: dict[int, int] = {}
    count = end = 0
    for kind, at, after in records(data):
        if kind == CHUNK:
            end = after
        elif kind == MESSAGE_INDEX:
            count += (after - at - HEAD - 6) // 16
            found[end] = count
        elif kind == MESSAGE:
            count += 1
            found[after] = count
    return list(found.items())


def first(data: bytes, kind: int, number: int = 0) -> Record:
    return [record for record in records(data) if record.kind == kind][number]


def changed(data: bytes, at: int, piece: bytes) -> bytes:
    return data[:at] + piece + data[at + len(piece) :]


def ours(path: Path) -> list[Told]:
    """Return the messages of a file as we read them."""
    with Bag(path) as bag:
        found = [
            (kept.channel.topic, kept.at, kept.published, kept.sequence, kept.data) for kept in bag.messages()
        ]
        assert len(found) == bag.count == sum(channel.messages for channel in bag.channels)
        return found


def theirs(path: Path) -> list[Told]:
    """Return the messages of a file as mcap reads them, and see to it that rosbags reads the same."""
    with path.open("rb") as file:
        found = [
            (channel.topic, one.log_time, one.publish_time, one.sequence, one.data)
            for _, channel, one in make_reader(file, validate_crcs=True).iter_messages()
        ]
    reader = McapReader(path)
    reader.open()
    try:
        others = [
            (connection.topic, at, data) for connection, at, data in reader.messages(reader.connections)
        ]
    finally:
        reader.close()
    assert others == [(topic, at, data) for topic, at, _, _, data in found]
    return found
