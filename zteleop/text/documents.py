"""Messages in a stream of text: each a line `{...}`, or a YAML document that ends with `---`."""

from collections.abc import Iterator

from zteleop.text.yaml_text import LONGEST


class Documents:
    """Splits what arrives; of a document that is too long it keeps enough to be refused."""

    def __init__(self) -> None:
        self._rest = b""
        self._lines: list[bytes] = []
        self._size = 0

    def feed(self, data: bytes) -> Iterator[str]:
        """Take more of the stream; yield the documents that are complete."""
        *lines, rest = (self._rest + data).split(b"\n")
        self._rest = rest[: LONGEST + 1]
        for line in lines:
            yield from self._take(line.rstrip())

    def end(self) -> Iterator[str]:
        """Yield what is left when the stream has ended."""
        rest, self._rest = self._rest, b""
        yield from self._take(rest.rstrip())
        yield from self._flush()

    def _take(self, line: bytes) -> Iterator[str]:
        if line in (b"---", b"..."):
            yield from self._flush()
        elif line.startswith(b"--- "):
            yield from self._flush()
            yield from self._take(line[4:].lstrip())
        elif line.startswith(b"{") and line.endswith(b"}"):
            yield from self._flush()
            yield _text(line)
        elif self._size <= LONGEST:
            self._lines.append(line)
            self._size += len(line) + 1

    def _flush(self) -> Iterator[str]:
        lines, self._lines, self._size = self._lines, [], 0
        if any(line and not line.lstrip().startswith(b"#") for line in lines):
            yield _text(b"\n".join(lines).strip(b"\n"))


def _text(data: bytes) -> str:
    return data.decode(errors="replace")
