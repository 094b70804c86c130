import pytest

from zteleop.cli._types import service_of
from zteleop.messages import SetBoolRequest, SetBoolResponse


@pytest.mark.parametrize("name", ["std_srvs/srv/SetBool", "std_srvs/SetBool", "SetBool"])
def test_a_service_is_known_by_each_of_its_names(name: str) -> None:
    assert service_of(name) == (SetBoolRequest, SetBoolResponse)


@pytest.mark.parametrize("name", ["Twist", "setbool", "acme_msgs/srv/SetBool"])
def test_what_is_none_is_none(name: str) -> None:
    assert service_of(name) == ()
