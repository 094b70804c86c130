import io
import os
from collections.abc import Iterator
from contextlib import suppress

import pytest


@pytest.fixture(params=["buffered", "unbuffered"])
def deaf(request: pytest.FixtureRequest) -> Iterator[io.TextIOWrapper]:
    """A stdout whose reader has left, as `zteleop ... | head` has it."""
    reader, writer = os.pipe()
    os.close(reader)
    buffering = 0 if request.param == "unbuffered" else -1
    stdout = io.TextIOWrapper(os.fdopen(writer, "wb", buffering), write_through=not buffering)
    yield stdout
    with suppress(BrokenPipeError):
        stdout.close()
