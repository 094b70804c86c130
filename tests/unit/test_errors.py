import importlib.metadata
import sys
from types import SimpleNamespace

import pytest

from zteleop.errors import (
    BusError,
    ConfigError,
    DeviceError,
    MessageError,
    RecordingError,
    ZteleopError,
    install,
    nearest,
)


@pytest.mark.parametrize(
    ("error", "builtin"),
    [
        (ConfigError, ValueError),
        (MessageError, ValueError),
        (BusError, OSError),
        (DeviceError, OSError),
        (RecordingError, OSError),
    ],
)
def test_each_error_is_ours_and_the_builtin_that_an_except_would_name(
    error: type[ZteleopError], builtin: type[Exception]
) -> None:
    assert issubclass(error, ZteleopError)
    assert issubclass(error, builtin)
    assert str(error("expected a, found b")) == "expected a, found b"


def test_no_error_is_another() -> None:
    kinds = (ConfigError, MessageError, BusError, DeviceError, RecordingError)
    assert not any(issubclass(a, b) for a in kinds for b in kinds if a is not b)


@pytest.mark.parametrize(
    ("name", "known", "words"),
    [
        ("odm", ["odom", "log"], "did you mean odom?"),
        (
            "x/msg/Twst",
            ["geometry_msgs/msg/Twist", "std_msgs/msg/Bool"],
            "did you mean geometry_msgs/msg/Twist?",
        ),
        ("xyz", ["b", "a", "a"], "known: a, b"),
        ("geometry_msgs/msg/Fog", ["geometry_msgs/msg/Twist"], "known: geometry_msgs/msg/Twist"),
        ("interface/buttons", ["interface_buttons", "odom"], "did you mean interface_buttons?"),
        ("xyz", [], "known: none"),
        ("xyz", [f"{n:02}" for n in range(23)], "19 and 3 more"),
    ],
)
def test_the_nearest_names_are_told_else_some_that_are_known(name: str, known: list[str], words: str) -> None:
    assert nearest(name, known).endswith(words)


@pytest.mark.parametrize(
    ("origin", "command"),
    [
        (None, "pip install 'zteleop[web]'"),
        ("not JSON", "pip install 'zteleop[web]'"),
        ('{"url": "https://a.example/z.whl"}', "pip install 'zteleop[web]'"),
        ('{"url": "file:///home/a%20b/z"}', f"{sys.executable} -m pip install '/home/a b/z[web]'"),
        (
            '{"url": "file:///z", "dir_info": {"editable": true}}',
            f"{sys.executable} -m pip install -e '/z[web]'",
        ),
    ],
)
def test_an_extra_is_added_to_where_this_was_installed_from(
    monkeypatch: pytest.MonkeyPatch, origin: str | None, command: str
) -> None:
    here = SimpleNamespace(read_text=lambda name: origin)
    monkeypatch.setattr(importlib.metadata, "distribution", lambda name: here)
    assert install("web") == command
