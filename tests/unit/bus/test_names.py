import re

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.names import Name, chunk, resolve, robot_name
from zteleop.errors import ConfigError

SAFE_KEY = re.compile(r"robot/[a-z0-9][a-z0-9_-]{0,62}(/[A-Za-z0-9_][A-Za-z0-9_-]{0,62})+")
TEXTS = st.one_of(st.text(max_size=80), st.text("aZ09_-/*$#?@. \n\x00é", max_size=12))


@pytest.mark.parametrize(
    ("text", "robot", "key"),
    [
        ("/archangel/odom", None, "robot/archangel/odom"),
        ("archangel/odom", None, "robot/archangel/odom"),
        ("robot/archangel/odom", None, "robot/archangel/odom"),
        ("odom", "archangel", "robot/archangel/odom"),
        ("chatter", "archangel", "robot/archangel/chatter"),
        ("archangel/odom", "other", "robot/archangel/odom"),
        ("/archangel/base/cmd_vel", None, "robot/archangel/base/cmd_vel"),
        ("archangel/cmd_vel/keyboard", "other", "robot/archangel/cmd_vel/keyboard"),
        ("cmd_vel/keyboard", "archangel", "robot/archangel/cmd_vel/keyboard"),
        ("controls", "archangel", "robot/archangel/pwm"),
        ("controls/web", "archangel", "robot/archangel/pwm/web"),
        ("/archangel/cmd_vel_stamped/nav", None, "robot/archangel/cmd_vel/nav"),
        ("robot/archangel/controls", None, "robot/archangel/pwm"),
        ("7-of_9/Scan-2", None, "robot/7-of_9/Scan-2"),
    ],
)
def test_every_way_to_say_a_topic_is_its_key(text: str, robot: str | None, key: str) -> None:
    assert resolve(text, robot).key == key


@pytest.mark.parametrize("text", ["odom", "cmd_vel/keyboard", "controls", "archangel/", ""])
def test_a_topic_without_a_robot_asks_for_one(text: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(f"{text!r} names no robot; say ROBOT/")):
        resolve(text, None)


@pytest.mark.parametrize("text", ["/", "//", "robot/", "robot/archangel", "/archangel/"])
def test_a_robot_without_a_topic_is_no_topic(text: str) -> None:
    with pytest.raises(ConfigError, match="a topic is ROBOT/TOPIC, such as"):
        resolve(text, "archangel")


@pytest.mark.parametrize(("text", "path"), [("/odom", "odom"), ("/chatter", "chatter"), ("/controls", "pwm")])
def test_a_topic_as_ros_says_it_is_the_robots_that_is_meant(text: str, path: str) -> None:
    assert resolve(text, "archangel") == Name("archangel", path)
    with pytest.raises(ConfigError, match=f"topic '{text}' names no robot; say ROBOT{text}"):
        resolve(text, None)


def test_a_name_that_could_be_two_robots_is_not_guessed() -> None:
    with pytest.raises(ConfigError, match="say /camera/image or /archangel/camera/image"):
        resolve("camera/image", "archangel")
    assert resolve("camera/image", None).robot == "camera"
    assert resolve("camera/odom", "archangel").robot == "camera"


@pytest.mark.parametrize(
    "text",
    [
        "archangel/*",
        "archangel/**",
        "*/odom",
        "**/odom",
        "arch*/odom",
        "archangel/o$*m",
        "archangel/odom?max=1",
        "archangel/odom#",
        "archangel/@odom",
        "archangel//odom",
        "archangel/o dom",
        "archangel/odom\n",
        "arch\x00angel/odom",
        "archangel/\x1b[2J",
        "archangel/ödom",
        "archangel/-odom",
        "archangel/" + "x" * 64,
        "Archangel/odom",
        "-archangel/odom",
        "_archangel/odom",
        "a" * 64 + "/odom",
    ],
)
def test_what_could_address_others_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="found"):
        resolve(text, None)


@pytest.mark.parametrize("robot", ["*", "", "Archangel", "a/b", "archangel\n"])
def test_a_selected_robot_is_checked_too(robot: str) -> None:
    with pytest.raises(ConfigError, match="a robot's name is"):
        resolve("odom", robot)


@given(TEXTS, st.sampled_from([None, "archangel"]))
def test_any_text_is_a_safe_key_or_a_config_error(text: str, robot: str | None) -> None:
    try:
        name = resolve(text, robot)
    except ConfigError:
        return
    assert SAFE_KEY.fullmatch(name.key)
    assert str(zenoh.KeyExpr(name.key)) == name.key
    assert resolve(name.key, None) == name


@pytest.mark.parametrize("name", ["a", "7", "car-7f3a", "a_b", "a" * 63])
def test_a_good_robots_name_stays_as_it_is(name: str) -> None:
    assert robot_name(name) == name


@pytest.mark.parametrize("name", ["", "a" * 64, "A", "-a", "_a", "a b", "a/b", "a*", "ä", "a\n", "a\x00"])
def test_a_bad_robots_name_is_refused_in_words(name: str) -> None:
    with pytest.raises(ConfigError, match=re.escape("1 to 63 of a-z, 0-9, _ and -, starting with")) as error:
        robot_name(name)
    assert str(error.value).endswith(f"found {name!r}")


@pytest.mark.parametrize("text", ["", "a/b", "*", "a b", "-a", "a.b", "x" * 64, "a\n"])
def test_a_bad_chunk_is_refused_by_what_it_should_be(text: str) -> None:
    with pytest.raises(ConfigError, match="a source is made of a-z, A-Z, 0-9, _ and -; found"):
        chunk(text, "a source")


def test_a_name_is_its_key() -> None:
    assert Name("archangel", "cmd_vel/web").key == "robot/archangel/cmd_vel/web"


@pytest.mark.parametrize(
    ("text", "robot", "found"),
    [
        ("camera/image/compressed", "abe", "abe/camera/image/compressed"),
        ("zoe/camera/image/compressed", "abe", "zoe/camera/image/compressed"),
        ("/zoe/camera/image/compressed", None, "zoe/camera/image/compressed"),
        ("camera/odom", None, "camera/odom"),
    ],
)
def test_a_known_topic_of_several_parts_is_no_robots_name(text: str, robot: str | None, found: str) -> None:
    assert str(resolve(text, robot)) == found
