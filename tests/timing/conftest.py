"""Every test of this folder claims a duration; who measures it must not be late himself."""

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

HERE = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.is_relative_to(HERE):
            item.add_marker("timing")


@pytest.fixture(autouse=True)
def first_in_line() -> Iterator[None]:
    """Let this thread look before all ordinary ones, where it is permitted; what it starts is ordinary."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    with suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(1))
    yield
    os.sched_setscheduler(0, *before)
