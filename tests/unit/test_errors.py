import pytest

from zteleop.errors import BusError, ConfigError, DeviceError, MessageError, ZteleopError


@pytest.mark.parametrize(
    ("error", "builtin"),
    [(ConfigError, ValueError), (MessageError, ValueError), (BusError, OSError), (DeviceError, OSError)],
)
def test_each_error_is_ours_and_the_builtin_that_an_except_would_name(
    error: type[ZteleopError], builtin: type[Exception]
) -> None:
    assert issubclass(error, ZteleopError)
    assert issubclass(error, builtin)
    assert str(error("expected a, found b")) == "expected a, found b"


def test_no_error_is_another() -> None:
    kinds = (ConfigError, MessageError, BusError, DeviceError)
    assert not any(issubclass(a, b) for a in kinds for b in kinds if a is not b)
