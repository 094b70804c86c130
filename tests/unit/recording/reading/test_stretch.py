from struct import pack

import pytest
from mcap import records as theirs
from mcap.data_stream import RecordBuilder

from zteleop.recording.reading import stretch
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.stretch import Stretch, Wanted


def written(*records: theirs.McapRecord) -> bytes:
    builder = RecordBuilder()
    for record in records:
        record.write(builder)
    return builder.end()


def channel(number: int, topic: str) -> theirs.Channel:
    return theirs.Channel(number, topic, "cdr", {}, 0)


def message(number: int, at: int, data: bytes = b"") -> theirs.Message:
    return theirs.Message(number, at, data, at + 1, 7)


def told(data: bytes, found: Stretch) -> list[tuple[str, int, int, int, bytes]]:
    return [
        (kept.channel.topic, kept.at, kept.published, kept.sequence, kept.data)
        for run in found.runs
        for kept in stretch.messages(data, run)
    ]


RECORDS = [channel(1, "/a"), message(1, 30, b"xyz"), channel(2, "/b"), message(2, 10), message(1, 20)]
DATA = written(*RECORDS)


def test_messages_are_found_with_what_explains_them() -> None:
    found = stretch.read(DATA, Directory())
    assert (found.end, found.wrong, found.begins, found.ends) == (len(DATA), "", 10, 30)
    assert DATA[found.last :] == written(message(1, 20))
    assert told(DATA, found) == [("/b", 10, 11, 7, b""), ("/a", 20, 21, 7, b""), ("/a", 30, 31, 7, b"xyz")]


@pytest.mark.parametrize(
    ("wanted", "times"),
    [
        (Wanted({"/a"}), [20, 30]),
        (Wanted({"/x"}), []),
        (Wanted(begin=20), [20, 30]),
        (Wanted(end=20), [10]),
        (Wanted({"/a"}, 21, 30), []),
    ],
)
def test_only_what_is_asked_for_is_found(wanted: Wanted, times: list[int]) -> None:
    assert [one[1] for one in told(DATA, stretch.read(DATA, Directory(), wanted))] == times


def test_a_number_that_means_something_else_from_there_on() -> None:
    data = written(channel(1, "/a"), message(1, 1), channel(1, "/b"), message(1, 2))
    assert [one[:2] for one in told(data, stretch.read(data, Directory()))] == [("/a", 1), ("/b", 2)]


def test_a_channel_that_is_described_too_late_is_known_all_the_same() -> None:
    data = written(message(1, 1), channel(1, "/a"), message(9, 2))
    assert [one[:2] for one in told(data, stretch.read(data, Directory()))] == [("/a", 1)]


def test_they_end_where_a_record_is_cut_off() -> None:
    ends = [len(written(*RECORDS[:number])) for number in range(len(RECORDS) + 1)]
    for cut in range(len(DATA)):
        found = stretch.read(DATA[:cut], Directory())
        assert found.end == max(end for end in ends if end <= cut)
        assert bool(found.wrong) == (found.end < cut)


@pytest.mark.parametrize(
    ("piece", "words"),
    [
        (pack("<BQ", 5, 21) + bytes(21), "21 bytes long, which none is"),
        (pack("<BQ", 5, 2**63) + bytes(40), "is not"),
        (pack("<BQ", 0, 0), "of the kind 0"),
        (pack("<BQ", 4, 3) + bytes(3), "ends within a number"),
    ],
)
def test_what_makes_no_sense_ends_them(piece: bytes, words: str) -> None:
    found = stretch.read(DATA + piece + DATA, Directory())
    assert found.end == len(DATA)
    assert words in found.wrong


def test_another_kind_of_record_is_passed_over_or_ends_them() -> None:
    data = DATA + pack("<BQ", 200, 5) + bytes(5) + written(message(1, 99))
    assert len(told(data, stretch.read(data, Directory()))) == 4
    assert len(told(data, stretch.read(data, Directory(), only_known=True))) == 3
