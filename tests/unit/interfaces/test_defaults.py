from typing import Any

import pytest

from zteleop.interfaces.defaults import with_defaults
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Twist

NAVIGATE = struct_of("irobot_create_msgs/action/NavigateToPosition_Goal")


def test_what_is_left_out_is_what_ros_says() -> None:
    found: Any = with_defaults(NAVIGATE, {"achieve_goal_heading": True})
    assert (found["max_translation_speed"], found["max_rotation_speed"]) == (0.3, 1.9)
    assert found["achieve_goal_heading"] is True


def test_a_message_in_it_has_its_own() -> None:
    found: Any = with_defaults(NAVIGATE, {"goal_pose": {"header": "auto"}})
    assert found["goal_pose"] == {
        "header": "auto",
        "pose": {"orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}},
    }


def test_what_is_given_stays() -> None:
    found: Any = with_defaults(NAVIGATE, {"max_rotation_speed": 0.5})
    assert found["max_rotation_speed"] == 0.5


@pytest.mark.parametrize("values", [{}, {"linear": {"x": 1}}, [1, 2], "text", None])
def test_a_message_without_defaults_is_as_it_was(values: object) -> None:
    assert with_defaults(Twist, values) == values
