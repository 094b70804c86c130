import pytest

from zteleop.text.documents import Documents
from zteleop.text.yaml_text import LONGEST

STREAMS = [
    (b'{"a": 1}\n{"a": 2}\n', ['{"a": 1}', '{"a": 2}']),
    (b"a: 1\nb: 2\n---\na: 3\n---\n", ["a: 1\nb: 2", "a: 3"]),
    (b"---\na: 1\n...\n---\na: 2", ["a: 1", "a: 2"]),
    (b"--- {a: 1}\n--- a: 2\n", ["{a: 1}", "a: 2"]),
    (b"{a: 1}\nb: 1\n{c: 1}\n", ["{a: 1}", "b: 1", "{c: 1}"]),
    (b"{a:\n 1}\n---\n", ["{a:\n 1}"]),
    (b"a: |\n  ---\n  x\n---\n", ["a: |\n  ---\n  x"]),
    (b"{a: 1}\r\n{b: 1}\r\n", ["{a: 1}", "{b: 1}"]),
    (b"# only words\n---\n\n\n---\n", []),
    (b"{}", ["{}"]),
    (b"", []),
    (b"\xff: 1\n", ["\ufffd: 1"]),
]


@pytest.mark.parametrize(("stream", "texts"), STREAMS)
@pytest.mark.parametrize("size", [1, 3, 1000])
def test_each_document_stands_alone_however_it_arrives(stream: bytes, texts: list[str], size: int) -> None:
    documents, found = Documents(), []
    for start in range(0, len(stream), size):
        found += documents.feed(stream[start : start + size])
    assert [*found, *documents.end()] == texts


def test_a_document_is_yielded_as_soon_as_it_is_complete() -> None:
    documents = Documents()
    assert list(documents.feed(b"a: 1\n--")) == []
    assert list(documents.feed(b"-\n{b")) == ["a: 1"]
    assert list(documents.feed(b": 1}\n")) == ["{b: 1}"]


@pytest.mark.parametrize("piece", [b"x" * 65536, b"x: 1\n" * 13000])
def test_what_has_no_end_does_not_grow_for_ever(piece: bytes) -> None:
    documents = Documents()
    for _ in range(40):
        assert list(documents.feed(piece)) == []
    (text,) = documents.feed(b"\n---\n")
    assert LONGEST < len(text) < LONGEST + 2 * 65536
    assert list(documents.feed(b"{a: 1}\n")) == ["{a: 1}"]
