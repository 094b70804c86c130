from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from judging import (  # noqa: F401  hooks
    pytest_collection_modifyitems,
    pytest_report_teststatus,
    pytest_runtest_makereport,
    pytest_runtest_protocol,
    pytest_sessionfinish,
    pytest_terminal_summary,
)
from rig import Rig

settings.register_profile("shared machine", deadline=None)
settings.load_profile("shared machine")


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    with Rig(tmp_path) as bench:
        yield bench
