from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from zteleop.bus.tap import Raw
from zteleop.messages import GetHistoryRequest, GetHistoryResponse
from zteleop.nodes.history import AT_ONCE, serve_history
from zteleop.recording.ring import Ring
from zteleop.testing import Clock


def said(at: float, path: str = "odom", payload: bytes = b"{}", deleted: bool = False) -> Raw:
    return Raw(at, path, "application/json;nav_msgs/msg/Odometry", payload, b"", deleted)


def served(ring: Ring) -> Callable[[GetHistoryRequest], GetHistoryResponse]:
    found: list[Any] = []
    node: Any = SimpleNamespace(robot="abe", service=lambda *about: found.append(about))
    serve_history(node, ring)
    handler: Callable[[GetHistoryRequest], GetHistoryResponse] = found[0][3]
    return handler


def test_what_was_said_in_the_last_seconds_of_one_topic_the_oldest_first(clock: Clock) -> None:
    ring = Ring(["odom", "cmd_vel/keyboard", "cmd_vel/program"])
    for at in range(10):
        ring.add(said(clock.time - 10 + at, "odom" if at % 2 else "cmd_vel/keyboard"))
    ring.add(said(clock.time - 0.5, "cmd_vel/program"))
    ring.add(said(clock.time - 0.45, "cmd_vel/keyboard"))
    ring.add(said(clock.time - 0.4, "odom", deleted=True))
    ask = served(ring)
    odom = ask(GetHistoryRequest("odom", 4.5, 0.0, 0))
    assert [clock.time - message.at for message in odom.messages] == [3.0, 1.0]
    commands = ask(GetHistoryRequest("cmd_vel", 4.5, 0.0, 0))
    assert [message.path.rpartition("/")[2] for message in commands.messages] == [
        "keyboard",
        "keyboard",
        "program",
        "keyboard",
    ]
    assert (odom.more, commands.more) == (False, False)
    assert ask(GetHistoryRequest("cmd", 60.0, 0.0, 0)).messages == [], "a name is no beginning of another"


def test_long_ones_come_in_pieces_of_which_none_is_lost_nor_had_twice(clock: Clock) -> None:
    ring = Ring(["odom"])
    sizes = [AT_ONCE // 3 + number for number in range(10)]
    for number, size in enumerate(sizes):  # by threes in one moment
        ring.add(said(clock.time - 10 + number // 3, payload=b"x" * size))
    ask, found, pieces = served(ring), list[int](), 0
    after, had, more = 0.0, 0, True
    while more:
        answer = ask(GetHistoryRequest("odom", 60.0, after, had))
        more, pieces = answer.more, pieces + 1
        assert sum(len(message.payload) for message in answer.messages) < 2 * AT_ONCE
        for message in answer.messages:
            had = had + 1 if message.at == after else 1
            after = message.at
            found.append(len(message.payload))
    assert found == sizes
    assert pieces > 2
