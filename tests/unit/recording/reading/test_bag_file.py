from pathlib import Path
from struct import pack

import pytest
from unit.recording.files import (
    CHUNK,
    CHUNK_INDEX,
    HEAD,
    LZ4,
    MESSAGE,
    NONE,
    STATISTICS,
    STRING,
    ZSTD,
    Told,
    changed,
    first,
    message,
    ours,
    recording,
    theirs,
)

from zteleop.errors import RecordingError
from zteleop.interfaces.form import Form
from zteleop.recording.reading.bag_file import BagFile

MESSAGES = [message(number) for number in range(12)]
QOS = {"offered_qos_profiles": ""}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "drive.mcap"


@pytest.mark.parametrize("compression", [NONE, ZSTD, LZ4])
def test_a_file_is_read_as_mcap_and_rosbags_read_it(compression: object, path: Path) -> None:
    path.write_bytes(recording(compression=compression))  # type: ignore[arg-type]
    assert ours(path) == theirs(path) == MESSAGES


@pytest.mark.parametrize(
    "option",
    [
        "use_chunking",
        "repeat_channels",
        "repeat_schemas",
        "use_statistics",
        "use_summary_offsets",
        "enable_crcs",
    ],
)
def test_a_file_may_lack_what_others_have(option: str, path: Path) -> None:
    path.write_bytes(recording(**{option: False}))
    with BagFile(path) as file:
        assert file.contents.messages == 12
        assert not file.trouble
        assert len(list(file.attachments())) == 1
    assert ours(path) == MESSAGES


def test_what_is_in_a_file(path: Path) -> None:
    path.write_bytes(recording())
    with BagFile(path) as file:
        found = file.contents
        assert (found.profile, found.library, found.compression, found.indexed) == (
            "ros2",
            "tests",
            ("zstd",),
            True,
        )
        assert (found.begins, found.ends, found.messages, found.chunks > 3) == (1000, 1110, 12, True)
        assert [(c.topic, c.form, c.metadata, c.messages) for c in found.channels.values()] == [
            (f"/r/t{n}", Form("std_msgs/msg/String", "cdr", "ros2msg", STRING), QOS, 4) for n in range(3)
        ]
        assert [(head.name, head.length) for head in file.heads()] == [("graph.json", 8)]
        assert file.size == len(recording())


@pytest.mark.parametrize("options", [{}, {"use_chunking": False}])
def test_only_some_topics_and_some_time_are_read(options: dict[str, bool], path: Path) -> None:
    path.write_bytes(recording(**options))
    with BagFile(path) as file:
        found = [(kept.channel.topic, kept.at) for kept in file.messages({"/r/t1", "/r/t2"}, 1040, 1080)]
        assert found == [(one[0], one[1]) for one in MESSAGES[4:8] if one[0] != "/r/t0"]
        assert [kept.at for kept in file.messages(end=1000)] == []
        assert [kept.at for kept in file.messages(begin=1110)] == [1110]
        assert [*file.messages(set())] == []


def shuffled(number: int, topics: int) -> Told:
    topic, _, *rest = message(number, topics)
    return topic, 1000 + number * 7 % 12 * 10, *rest


@pytest.mark.parametrize("options", [{}, {"use_chunking": False}, {"use_statistics": False}])
def test_messages_come_as_they_arrived_whatever_their_place(options: dict[str, bool], path: Path) -> None:
    path.write_bytes(recording(told=shuffled, **options))
    wanted = sorted((shuffled(number, 3) for number in range(12)), key=lambda one: one[1])
    assert ours(path) == wanted


def test_messages_of_one_time_come_as_they_are_in_the_file(path: Path) -> None:
    path.write_bytes(recording(told=lambda number, topics: (message(number)[0], 7, 7, number, b"")))
    assert [one[3] for one in ours(path)] == list(range(12))


@pytest.mark.parametrize("options", [{}, {"use_chunking": False}, {"use_statistics": False}])
def test_times_at_both_ends_of_all_time(options: dict[str, bool], path: Path) -> None:
    times = [0, 1, 2**63 - 1, 2**63, 2**64 - 1]
    path.write_bytes(recording(5, told=lambda n, _: (message(n)[0], times[n], times[-n], n, b""), **options))
    with BagFile(path) as file:
        assert [kept.at for kept in file.messages()] == times
        assert (file.contents.begins, file.contents.ends) == (0, 2**64 - 1)
        assert [kept.at for kept in file.messages(begin=2**63)] == times[3:]
        assert [*file.messages(end=0)] == []


def test_a_file_without_messages(path: Path) -> None:
    for options in ({}, {"use_chunking": False}, {"use_statistics": False}):
        path.write_bytes(recording(0, **options))
        with BagFile(path) as file:
            assert file.contents.messages == file.contents.begins == file.contents.ends == 0
            assert len(file.contents.channels) == 3
            assert [*file.messages()] == []


def test_two_readers_of_one_file_do_not_disturb_each_other(path: Path) -> None:
    path.write_bytes(recording())
    with BagFile(path) as file:
        one, other = file.messages(), file.messages({"/r/t1"})
        found = [(next(one).at, next(other).at) for _ in range(4)]
        assert [head.name for head in file.heads()] == ["graph.json"]
        assert found == [(1000 + n * 10, 1010 + n * 30) for n in range(4)]
        assert len([*one]) == 8


LIES = [
    (STATISTICS, 0, pack("<Q", 13)),
    (STATISTICS, 26, pack("<Q", 2**63)),
    (STATISTICS, 42, pack("<I", 2**32 - 1)),
    (CHUNK_INDEX, 16, pack("<Q", 2**63)),
    (CHUNK_INDEX, 16, pack("<Q", 3)),
    (CHUNK_INDEX, 24, pack("<Q", 2**40)),
    (CHUNK_INDEX, 32, pack("<I", 2**32 - 1)),
    (CHUNK_INDEX, 0, pack("<Q", 2**64 - 1)),
    (CHUNK, 16, pack("<Q", 2**62)),
    (CHUNK, 24, pack("<I", 1)),
    (CHUNK, 28, pack("<I", 2**31)),
    (CHUNK, 36, pack("<Q", 2**50)),
    (CHUNK, -8, pack("<Q", 2**50)),
]
"""of a record of a kind, at a place, and not true"""


@pytest.mark.parametrize(("kind", "at", "lie"), LIES)
def test_a_lie_costs_no_more_than_it_touches(kind: int, at: int, lie: bytes, path: Path) -> None:
    data = recording()
    path.write_bytes(changed(data, first(data, kind, 1 if kind == CHUNK else 0).at + HEAD + at, lie))
    with BagFile(path) as file:
        found = [
            (one.channel.topic, one.at, one.published, one.sequence, one.data) for one in file.messages()
        ]
        assert len(found) >= 8
        assert found == [one for one in MESSAGES if one in found]
        assert "zteleop bag recover mends it" in file.trouble or len(found) == 12


def test_messages_of_a_channel_that_is_not_described_are_left_out_and_told(path: Path) -> None:
    data = recording(use_chunking=False, use_statistics=False)
    path.write_bytes(changed(data, first(data, MESSAGE, 4).at + HEAD, pack("<H", 99)))
    assert ours(path) == MESSAGES[:4] + MESSAGES[5:]
    with BagFile(path) as file:
        assert "1 message of channels that it does not describe" in (file.contents, file.trouble)[1]


def test_an_attachment_that_was_changed_is_told(path: Path) -> None:
    data = recording()
    path.write_bytes(changed(data, data.index(b'{"a": 1}'), b'{"b"'))
    with BagFile(path) as file:
        assert [one.data for one in file.attachments()] == [b'{"b": 1}']
        assert "graph.json has changed" in file.trouble


def test_no_more_than_a_few_troubles_are_told(path: Path) -> None:
    data = recording(200)
    for number in range(20):
        data = changed(data, first(data, CHUNK, number).at + HEAD + 24, pack("<I", number + 1))
    path.write_bytes(data)
    with BagFile(path) as file:
        assert len([*file.messages()]) == 200
        assert len(file.troubles) < 6


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is empty"),
        (b"\x89MCAP", "cut off after 5 bytes"),
        (b"#ROSBAG V2.0\n", "a bag of ROS 1; to turn it into MCAP say: pip install rosbags"),
        (b"SQLite format 3\0...", "SQLite"),
        (b"\x28\xb5\x2f\xfd.....", "zstd -d "),
        (b"\x1f\x8b.....", "zteleop blackbox "),
        (b"a,b\n1,2\n", "found another kind of file"),
    ],
)
def test_another_kind_of_file_is_refused_in_words(data: bytes, words: str, path: Path) -> None:
    path.write_bytes(data)
    with pytest.raises(RecordingError, match=words):
        BagFile(path)


def test_no_file_is_refused_in_words(path: Path) -> None:
    with pytest.raises(RecordingError, match=r"cannot open .*drive\.mcap: No such file"):
        BagFile(path)
    with pytest.raises(RecordingError, match="expected a file, found none at"):
        BagFile(path.parent)
    with pytest.raises(RecordingError, match="expected a file, found none at"):
        BagFile(Path("/dev/null"))


def test_a_file_that_becomes_shorter_while_it_is_read_ends_in_words(path: Path) -> None:
    path.write_bytes(recording(2000, NONE, 10_000))
    with BagFile(path) as file:
        reading = file.messages()
        next(reading)
        path.write_bytes(path.read_bytes()[:20_000])
        assert len([*reading]) < 2000
        assert "shorter" in file.trouble
