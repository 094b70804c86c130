"""A recording: one file, or a folder of them as rosbag2 writes it, read as one."""

import heapq
from collections.abc import Collection, Iterator
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Self

from zteleop.interfaces.channel_form import Form
from zteleop.recording.reading.bag_file import BagFile
from zteleop.recording.reading.bag_folder import files_of
from zteleop.recording.reading.contents import Attachment, Channel, Kept
from zteleop.recording.reading.records import AttachmentHead


class Bag:
    """The files of a recording, in a `with`; raises RecordingError when there is none."""

    def __init__(self, path: Path, thorough: bool = False) -> None:
        """With `thorough` the ends of its files are not believed: all of them is looked through."""
        self._stack = ExitStack()
        with ExitStack() as opening:
            self.files = [opening.enter_context(BagFile(one, thorough)) for one in files_of(path)]
            self._stack = opening.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()

    @property
    def channels(self) -> list[Channel]:
        """Every topic in each of its forms, sorted, with how many messages there are in all."""
        found: dict[tuple[str, Form], Channel] = {}
        for file in self.files:
            for channel in file.contents.channels.values():
                before = found.setdefault((channel.topic, channel.form), channel._replace(messages=0))
                messages = before.messages + channel.messages
                found[channel.topic, channel.form] = before._replace(messages=messages)
        return sorted(found.values(), key=lambda channel: (channel.topic, channel.form.type))

    @property
    def count(self) -> int:
        return sum(file.contents.messages for file in self.files)

    @property
    def begins(self) -> int:
        """When the first message arrived, in ns since 1970; 0 where there is none."""
        return min((file.contents.begins for file in self.files if file.contents.messages), default=0)

    @property
    def ends(self) -> int:
        return max((file.contents.ends for file in self.files), default=0)

    @property
    def troubles(self) -> list[str]:
        """What is wrong with its files, a sentence each."""
        return [f"{file.path}: {file.trouble}" for file in self.files if file.trouble]

    def messages(
        self, topics: Collection[str] | None = None, begin: int | None = None, end: int | None = None
    ) -> Iterator[Kept]:
        """Yield messages as they arrived: of some topics, from a time on and before another, in ns."""
        each = [file.messages(topics, begin, end) for file in self.files]
        yield from each[0] if len(each) == 1 else heapq.merge(*each, key=lambda kept: kept.at)

    def attachments(self) -> Iterator[Attachment]:
        for file in self.files:
            yield from file.attachments()

    def heads(self) -> Iterator[AttachmentHead]:
        """Yield what the attachments are called, and how long they are."""
        for file in self.files:
            yield from file.heads()

    def notes(self) -> Iterator[tuple[str, dict[str, str]]]:
        """Yield what is said of it, each under a name, which may be said twice."""
        for file in self.files:
            yield from file.notes()

    def metadata(self) -> dict[str, dict[str, str]]:
        """Return what is said of it, by name; of files that say it twice, the first's."""
        found: dict[str, dict[str, str]] = {}
        for file in reversed(self.files):
            found |= file.metadata()
        return found
