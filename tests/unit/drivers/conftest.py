import pytest
from unit.drivers.wire import Wire


@pytest.fixture
def wire() -> Wire:
    return Wire()
