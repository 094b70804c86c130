import pytest

from zteleop.interfaces.definition import definition
from zteleop.interfaces.integers import NAMES
from zteleop.messages import MESSAGES


@pytest.mark.parametrize("name", NAMES.values())
def test_a_name_says_how_many_numbers_there_are(name: str) -> None:
    ((least, below),) = [bounds for bounds, its in NAMES.items() if its == name]
    assert isinstance(least, int)
    if isinstance(below, int):
        assert below - least == 2 ** int(name.removeprefix("u").removeprefix("int"))


def test_a_field_is_called_by_its_bounds() -> None:
    assert "uint32 nanosec" in definition(MESSAGES["builtin_interfaces/msg/Time"])
