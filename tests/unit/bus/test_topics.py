import msgspec
import pytest

from zteleop.bus.names import resolve
from zteleop.bus.topics import ALIASES, TOPICS, topic_of
from zteleop.messages import MESSAGES, Int16MultiArray, Pwm, Twist, TwistStamped


def test_aliases_lead_to_their_topics_and_topics_list_them() -> None:
    assert ALIASES == {"cmd_vel_stamped": "cmd_vel", "controls": "pwm"}
    for alias, name in ALIASES.items():
        assert alias in TOPICS[name].aliases
        assert alias not in TOPICS
        assert resolve(alias, "archangel") == resolve(name, "archangel")


def test_each_topic_stands_under_its_own_name_with_known_types() -> None:
    for name, topic in TOPICS.items():
        assert topic.name == name
        assert topic.types
        assert all(MESSAGES[kind.ros_type] is kind for kind in topic.types)


def test_only_what_moves_the_robot_is_a_command_and_it_is_urgent() -> None:
    commands = {name: topic.types for name, topic in TOPICS.items() if topic.command}
    assert commands == {"cmd_vel": (TwistStamped, Twist), "pwm": (Pwm, Int16MultiArray)}
    assert all(TOPICS[name].urgent for name in commands)


@pytest.mark.parametrize("path", ["cmd_vel", "cmd_vel/keyboard", "cmd_vel/a/b"])
def test_every_source_belongs_to_its_topic(path: str) -> None:
    assert topic_of(path) is TOPICS["cmd_vel"]


@pytest.mark.parametrize("path", ["chatter", "base/cmd_vel", "cmd_velocity", "live/node"])
def test_an_unknown_topic_is_a_plain_one(path: str) -> None:
    topic = topic_of(path)
    assert (topic.name, topic.types, topic.command, topic.urgent) == (path, (), False, False)


@pytest.mark.parametrize("ticks", [-32769, 32768, 375.5, "375"])
def test_pulses_are_whole_numbers_of_sixteen_bits(ticks: object) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert({"steering_ticks": ticks, "throttle_ticks": 370}, Pwm)
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert({"layout": {"dim": [], "data_offset": 0}, "data": [ticks, 370]}, Int16MultiArray)
