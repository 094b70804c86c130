"""One MCAP file, written as ROS 2 does: each channel says all that is needed to read it.

What is written is a chunk in memory until `flush`, or until the chunk is full; a file without its end is
read as far as the last chunk.
"""

import struct
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from mcap import records

from zteleop.errors import RecordingError
from zteleop.recording.form import Form
from zteleop.recording.writing.bag_end import MAGIC, BagEnd
from zteleop.recording.writing.chunk import Chunk, Compression, Row, packed

CHUNK = 2 * 2**20
"""bytes after which a chunk is full; a file's end says of each chunk which topics are in it"""
PROFILE, LIBRARY = "ros2", "zteleop"
CHANNELS = 2**16 - 1
"""that a file can have"""
QOS = "offered_qos_profiles"
"""what rosbag2 expects each channel to say, if only as an empty text"""

ChannelKey = tuple[str, Form, tuple[tuple[str, str], ...]]


class Stream(Protocol):
    """Where a file's bytes go; raises OSError when they cannot."""

    def write(self, data: bytes, /) -> object: ...

    def flush(self) -> object: ...

    def close(self) -> object: ...


class BagWriter:
    """A file that is written, in a `with`; raises RecordingError when it is there already, or refuses.

    With a `stream` what is written goes there; the path is what the file is called.
    """

    def __init__(
        self,
        path: Path,
        compression: Compression = "zstd",
        stream: Stream | None = None,
        chunk_size: int = CHUNK,
        profile: str = PROFILE,
    ) -> None:
        self.path = path
        self._compression = compression
        self._chunk_size = chunk_size
        self._stream: Stream = stream or _create(path)
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._channels: dict[ChannelKey, int] = {}
        self._chunk = Chunk()
        self._end = BagEnd()
        self._closed = False
        self.refused = ""
        """why it could not be written on; its end is missing"""
        self._size = 0
        self._put(MAGIC + packed(records.Header(profile, LIBRARY)))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def messages(self) -> int:
        """How many were written."""
        return self._end.messages + self._chunk.messages

    @property
    def counts(self) -> Mapping[int, int]:
        """How many, of each channel; complete once it is closed."""
        return self._end.counts

    @property
    def begins(self) -> int:
        """When the first message came, in ns since 1970; 0 where there is none. As complete."""
        return self._end.begins

    @property
    def ends(self) -> int:
        return self._end.ends

    @property
    def size(self) -> int:
        """Bytes, without what waits in the chunk."""
        return self._size

    @property
    def waiting(self) -> int:
        """Bytes of the chunk."""
        return len(self._chunk.data)

    def add(self, topic: str, form: Form, metadata: Mapping[str, str] | None = None) -> int:
        """Return the number of a channel, which is a new one unless the same was added before."""
        told = {QOS: ""} | dict(metadata or {})
        key = (topic, form, tuple(told.items()))
        if key not in self._channels:
            if len(self._channels) == CHANNELS:
                raise RecordingError(f"{self.path} has {CHANNELS} channels, and can have no more")
            number = len(self._channels) + 1
            channel = records.Channel(number, topic, form.encoding, told, self._schema(form))
            self._describe(channel)
            self._channels[key] = number
        return self._channels[key]

    def write(self, channel: int, at: int, published: int, sequence: int, data: bytes) -> None:
        """Write a message: when it arrived, and when it was said, in ns since 1970."""
        self.extend([(channel, at, published, sequence, data)])

    def extend(self, messages: Iterable[Row]) -> None:
        """Write some messages."""
        chunk = self._chunk
        try:
            chunk.add(messages)
        except struct.error:
            raise RecordingError(
                f"{self.path} keeps times in ns since 1970, and found one that is none"
            ) from None
        if len(chunk.data) >= self._chunk_size:
            self._finish_chunk()

    def attach(self, name: str, media_type: str, at: int, data: bytes, created: int | None = None) -> None:
        """Add what is no message, such as `graph.json`; it was made when it was added, or before."""
        attachment = records.Attachment(at if created is None else created, at, name, media_type, data)
        record = packed(attachment)
        self._end.attached(attachment, self._size, len(record))
        self._put(record)

    def describe(self, name: str, metadata: Mapping[str, str]) -> None:
        """Add what is said of the whole recording, under a name."""
        record = packed(records.Metadata(name, dict(metadata)))
        self._end.described(name, self._size, len(record))
        self._put(record)

    def flush(self) -> None:
        """Finish the chunk: what was written so far can be read from the file, however this process ends."""
        if self._chunk.messages:
            self._finish_chunk()
        self.guard(self._stream.flush)

    def close(self) -> None:
        """Write the end of the file; of one that refused, nothing more."""
        if self._closed:
            return
        try:
            if self._chunk.data:
                self._finish_chunk()
            self._put(self._end.text(self._size))
            self.guard(self._stream.close)
        finally:
            self._leave()
            self._end.forget()
            self._channels.clear()

    def guard(self, action: Callable[..., object], *arguments: bytes) -> None:
        """Do something with the file; raises RecordingError when it refuses, or did before."""
        if self.refused:
            raise RecordingError(self.refused)
        try:
            action(*arguments)
        except (OSError, ValueError) as error:
            self.refused = f"cannot write {self.path}: {getattr(error, 'strerror', None) or error}"
            self._leave()
            raise RecordingError(self.refused) from None

    def _schema(self, form: Form) -> int:
        """Return the number of a schema; 0 where not even a type is known."""
        if not form.type:
            return 0
        key = (form.type, form.schema_encoding, form.schema)
        if key not in self._schemas:
            number = self._schemas[key] = len(self._schemas) + 1
            self._describe(records.Schema(number, form.schema, form.schema_encoding, form.type))
        return self._schemas[key]

    def _describe(self, record: records.Schema | records.Channel) -> None:
        self._chunk.describe(record)
        self._end.known(record)

    def _finish_chunk(self) -> None:
        pressed = self._chunk.press(self._size, self._compression)
        self._end.chunk(pressed)
        self._chunk = Chunk()
        self._put(pressed.record)

    def _put(self, data: bytes) -> None:
        self.guard(self._stream.write, data)
        self._size += len(data)

    def _leave(self) -> None:
        self._closed = True
        with suppress(OSError, ValueError):
            self._stream.close()


def _create(path: Path) -> Stream:
    try:
        return path.open("xb")
    except FileExistsError:
        raise RecordingError(f"{path} is there already, and is not overwritten; say another name") from None
    except OSError as error:
        raise RecordingError(f"cannot write {path}: {error.strerror}") from None
