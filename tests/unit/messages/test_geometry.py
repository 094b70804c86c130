import pytest

from zteleop.errors import MessageError
from zteleop.messages import Twist, Vector3


def test_a_planar_twist_is_forward_and_to_the_left() -> None:
    assert Twist.planar(0.5, -1.0) == Twist(Vector3(0.5, 0.0, 0.0), Vector3(0.0, 0.0, -1.0))


@pytest.mark.parametrize("wrong", ["fast", None, [1.0]])
def test_a_planar_twist_of_what_is_no_number_is_refused_in_words(wrong: object) -> None:
    with pytest.raises(MessageError, match="expected numbers, in m/s and rad/s, found linear="):
        Twist.planar(wrong, 0.0)  # type: ignore[arg-type]


def test_a_planar_twist_is_rest_where_nothing_is_said() -> None:
    assert Twist.planar() == Twist.zero()


def test_whole_numbers_become_floats_as_ros_has_them() -> None:
    twist = Twist.planar(1, 2)
    assert {type(axis) for vector in (twist.linear, twist.angular) for axis in (vector.x, vector.z)} == {
        float
    }
