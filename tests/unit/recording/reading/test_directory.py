import pytest
from mcap import records as theirs
from unit.recording.reading.test_records import body

from zteleop.interfaces.form import Form
from zteleop.recording.reading import directory
from zteleop.recording.reading.directory import Directory
from zteleop.recording.reading.records import BrokenError

SCHEMA = body(theirs.Schema(1, b"text", "ros2msg", "a/B"))


def channel(number: int, topic: str, schema: int = 1) -> bytes:
    return body(theirs.Channel(number, topic, "cdr", {}, schema))


@pytest.fixture
def known() -> Directory:
    return Directory().with_schema(SCHEMA).with_channel(channel(1, "/a"))


def test_a_channel_has_the_form_that_its_schema_tells(known: Directory) -> None:
    assert known.channels[1].form == Form("a/B", "cdr", "ros2msg", b"text")
    assert known.numbers({"/a", "/x"}) == {1}


def test_what_is_said_again_changes_nothing(known: Directory) -> None:
    before = known.channels[1]
    assert known.with_schema(SCHEMA).with_channel(channel(1, "/a")) is known
    assert known.with_channel(channel(2, "/b")) is known
    assert known.channels[1] is before


def test_what_was_read_before_a_number_changed_stays_what_it_was(known: Directory) -> None:
    after = known.with_channel(channel(1, "/b"))
    assert (known.channels[1].topic, after.channels[1].topic) == ("/a", "/b")
    other = after.with_schema(body(theirs.Schema(1, b"other", "ros2msg", "a/C")))
    assert other.channels[1].form.type == "a/B"
    assert other.with_channel(channel(1, "/b")).channels[1].form.type == "a/C"


def test_a_schema_that_is_missing_is_none(known: Directory) -> None:
    assert not known.with_channel(channel(3, "/c", 0)).lacks_schemas()
    assert known.with_channel(channel(2, "/b", 9)).channels[2].form == Form("", "cdr")
    assert known.lacks_schemas()


def test_numbers_that_change_for_ever_are_broken(known: Directory) -> None:
    for number in range(directory.MOST_CHANGES):
        known = known.with_channel(channel(1, f"/{number}"))
    with pytest.raises(BrokenError, match="again and again"):
        known.with_channel(channel(1, "/x"))


def test_more_definitions_than_fit_are_broken(known: Directory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(directory, "MOST", known.size + len(channel(2, "/b")))
    known.with_channel(channel(2, "/b"))
    with pytest.raises(BrokenError, match="bytes of schemas and channels"):
        known.with_channel(channel(3, "/c"))
