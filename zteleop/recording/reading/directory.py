"""What the numbers of schemas and channels stand for in a file."""

from collections.abc import Collection

from zteleop.interfaces.channel_form import Form
from zteleop.recording.reading import records
from zteleop.recording.reading.contents import Channel
from zteleop.recording.reading.records import BrokenError, Schema

MOST = 2**28
"""bytes of definitions that a file may have"""
MOST_CHANGES = 64
"""times that a number may come to stand for something else; each costs a copy"""


class Directory:
    """Grows as definitions are read; where a number comes to stand for something else, it is another one.

    Whoever has read messages with a directory can so read them again, later and in another order.
    """

    def __init__(self) -> None:
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, Schema] = {}
        self.said: dict[tuple[int, int], bytes] = {}
        """the record of each, by its kind and number"""
        self.size = 0
        """bytes of all records"""
        self.changes = 0
        """times that a number came to stand for something else"""

    def with_schema(self, record: bytes) -> "Directory":
        """Return what is known after a schema was read; raises BrokenError where it is none."""
        found = records.schema(record)
        return self._with(records.SCHEMA, found.number, record, found)

    def with_channel(self, record: bytes) -> "Directory":
        """Return what is known after a channel was read; raises BrokenError where it is none."""
        number = records.Fields(record).u16()
        if self.said.get((records.CHANNEL, number)) == record:  # as it is in each chunk
            return self
        return self._with(records.CHANNEL, number, record, self._channel(record))

    def numbers(self, topics: Collection[str]) -> set[int]:
        """Return the numbers that stand for some topics."""
        return {number for number, channel in self.channels.items() if channel.topic in topics}

    def lacks_schemas(self) -> bool:
        """Say whether a channel has a schema that is not there."""
        said = [record for (kind, _), record in self.said.items() if kind == records.CHANNEL]
        numbers = {records.channel(record).schema for record in said}
        return bool(numbers - self.schemas.keys() - {0})

    def _with(self, kind: int, number: int, record: bytes, found: Schema | Channel) -> "Directory":
        said = self.said.get((kind, number))
        if said == record:
            return self
        if self.size + len(record) > MOST:
            raise BrokenError(f"it has more than {MOST} bytes of schemas and channels")
        if self.changes == MOST_CHANGES:
            raise BrokenError(
                "the numbers of its schemas or channels change what they stand for, again and again"
            )
        after = self if said is None else self._changed()
        after.said[kind, number] = record
        after.size += len(record)
        if isinstance(found, Schema):
            after.schemas[number] = found
        else:
            after.channels[number] = found
        return after

    def _channel(self, record: bytes) -> Channel:
        found = records.channel(record)
        schema = self.schemas.get(found.schema)
        if schema is None:
            return Channel(found.topic, Form("", found.encoding), found.metadata)
        form = Form(schema.name, found.encoding, schema.encoding, schema.data)
        return Channel(found.topic, form, found.metadata)

    def _changed(self) -> "Directory":
        other = Directory()
        other.channels, other.schemas = dict(self.channels), dict(self.schemas)
        # a channel that is said again may be of the schema that has changed
        other.said = {key: record for key, record in self.said.items() if key[0] == records.SCHEMA}
        other.size, other.changes = self.size, self.changes + 1
        return other
