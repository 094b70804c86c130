import time
from collections.abc import Iterator

import pytest
from unit.bus.fakes import put, sample

from zteleop.cli import log
from zteleop.cli._listening import Arrival
from zteleop.messages import Log, Time

CLOCK = "05:30:05.007"
"""of a reader in India, where the stamp says 5.007 s after 1970 began"""


@pytest.fixture(autouse=True)
def india(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("TZ", "Asia/Kolkata")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def shown(
    level: int = Log.WARN, text: str = "it smells", least: int = Log.INFO, *nodes: str, color: bool = False
) -> list[str]:
    said = Log(Time(5, 7_900_000), level, "actuator", text, "", "", 0)
    return list(log.lines(Arrival(0.0, sample(said)), least, nodes, color))


def test_a_line_is_written_as_ros_does() -> None:
    assert shown() == [f"[WARN] [{CLOCK}] [actuator]: it smells"]
    assert shown(level=33)[0].startswith("[33] ")


def test_only_what_is_wanted_is_shown() -> None:
    assert shown(Log.INFO, "x", Log.WARN) == []
    assert shown(Log.WARN, "x", Log.INFO, "watchdog") == []
    assert shown(Log.WARN, "x", Log.INFO, "watchdog", "actuator") != []


def test_a_warning_has_a_colour_and_nothing_else_steers_a_terminal() -> None:
    assert shown(color=True) == [f"\x1b[33m[WARN] [{CLOCK}] [actuator]: it smells\x1b[0m"]
    assert "\x1b" not in shown(text="\x1b[2J")[0]


@pytest.mark.parametrize("bad", [b"{}", b"\xff", b"[]"])
def test_what_is_no_log_is_said_to_be_none(bad: bytes) -> None:
    (line,) = log.lines(
        Arrival(0.0, put(bad, "application/json;rcl_interfaces/msg/Log", "robot/abe/log")), 0, (), False
    )
    assert line.startswith("robot/abe/log: not a rcl_interfaces/msg/Log")
