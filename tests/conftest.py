from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from rig import Rig

settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        yield bench
