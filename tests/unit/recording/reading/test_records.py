import struct
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap import records as theirs
from mcap.data_stream import RecordBuilder

from zteleop.recording.reading import records
from zteleop.recording.reading.records import HEAD, BrokenError, Fields

READ = [
    records.header,
    records.schema,
    records.channel,
    records.chunk_head,
    records.chunk_index,
    records.attachment_head,
    records.attachment_index,
    records.metadata,
    records.metadata_index,
    records.statistics,
    records.footer,
]


def body(record: theirs.McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    return builder.end()[HEAD.size :]


def test_records_say_what_mcap_has_written() -> None:
    assert records.header(body(theirs.Header("ros2", "me"))) == ("ros2", "me")
    assert records.schema(body(theirs.Schema(7, b"data", "ros2msg", "a/b"))) == (7, "a/b", "ros2msg", b"data")
    channel = theirs.Channel(3, "/a", "cdr", {"k": "v", "": ""}, 7)
    assert records.channel(body(channel)) == (3, 7, "/a", "cdr", {"k": "v", "": ""})
    chunk = theirs.Chunk(
        compression="zstd",
        data=b"xyz",
        message_end_time=2,
        message_start_time=1,
        uncompressed_crc=9,
        uncompressed_size=10,
    )
    head = records.chunk_head(body(chunk))
    assert head == (1, 2, 10, 9, "zstd", 3, head.at)
    assert body(chunk)[head.at :] == b"xyz"
    index = theirs.ChunkIndex(
        chunk_length=20,
        chunk_start_offset=10,
        compression="lz4",
        compressed_size=3,
        message_end_time=2,
        message_index_length=5,
        message_index_offsets={4: 100},
        message_start_time=1,
        uncompressed_size=10,
    )
    told = records.chunk_index(body(index))
    assert told == (1, 2, 10, struct.pack("<HQ", 4, 100), "lz4", 3, 10)
    attachment = theirs.Attachment(
        create_time=1, log_time=2, name="a.txt", media_type="text/plain", data=b"hello"
    )
    found = records.attachment_head(body(attachment))
    assert found == (2, 1, "a.txt", "text/plain", 5, found.starts)
    assert body(attachment)[found.starts :][:5] == b"hello"
    where = theirs.AttachmentIndex(
        offset=50, length=60, create_time=1, log_time=2, data_size=5, name="a.txt", media_type="text/plain"
    )
    assert records.attachment_index(body(where)) == (50, 60, 2, 5, "a.txt", "text/plain")
    assert records.metadata(body(theirs.Metadata("n", {"a": "b"}))) == ("n", {"a": "b"})
    assert records.metadata_index(body(theirs.MetadataIndex(7, 8, "n"))) == (7, 8)
    assert records.footer(body(theirs.Footer(77, 88, 1))) == 77
    statistics = theirs.Statistics(
        attachment_count=1,
        channel_count=2,
        channel_message_counts={5: 6},
        chunk_count=3,
        message_count=4,
        message_end_time=9,
        message_start_time=8,
        metadata_count=7,
        schema_count=1,
    )
    assert records.statistics(body(statistics)) == (4, 1, 7, 3, 8, 9, {5: 6})


@given(st.binary(max_size=80))
def test_any_bytes_are_a_record_or_broken(data: bytes) -> None:
    for read in READ:
        with suppress(BrokenError):
            read(data)


def test_a_chunk_that_is_packed_in_an_unknown_way_is_broken() -> None:
    with pytest.raises(BrokenError, match="packed as 'xz'"):
        records.chunk_head(body(theirs.Chunk("xz", b"", 0, 0, 0, 0)))


def test_a_text_that_is_none_is_read_all_the_same() -> None:
    assert Fields(b"\2\0\0\0\xff\xfe").text() == "\ufffd\ufffd"
