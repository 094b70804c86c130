import pytest

from zteleop.bus.settings import BusSettings
from zteleop.cli._types import find_type, service_of
from zteleop.errors import MessageError
from zteleop.messages import SetBoolRequest, SetBoolResponse


@pytest.mark.parametrize("name", ["std_srvs/srv/SetBool", "std_srvs/SetBool", "SetBool"])
def test_a_service_is_known_by_each_of_its_names(name: str) -> None:
    assert service_of(name) == (SetBoolRequest, SetBoolResponse)


@pytest.mark.parametrize("name", ["Twist", "setbool", "acme_msgs/srv/SetBool"])
def test_what_is_none_is_none(name: str) -> None:
    assert service_of(name) == ()


@pytest.mark.parametrize("text", ["{linear: {x: 0.2}}", "0.2", "[1]", "-0.5"])
def test_values_whose_type_was_left_out_are_not_taken_for_one(text: str) -> None:
    with pytest.raises(MessageError) as error:
        find_type(text, BusSettings(multicast=False))
    assert str(error.value) == f"expected a type before the values, such as Twist, found {text!r}"
