from collections.abc import Iterator

import pytest
from fuzz import reading


@pytest.fixture(scope="session", autouse=True)
def no_scratch_is_left() -> Iterator[None]:
    yield
    reading.scratch.cache_clear()
    for folder in reading.FOLDERS:
        folder.cleanup()
    reading.FOLDERS.clear()
