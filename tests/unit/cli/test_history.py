from collections.abc import Callable

import pytest
from unit.bus import fakes
from unit.bus.fakes import put

from zteleop.bus import codec
from zteleop.bus.names import Name
from zteleop.bus.session import Reply
from zteleop.cli._history import OVERLAP, History
from zteleop.cli._listening import Arrival, Listening
from zteleop.errors import BusError
from zteleop.messages import GetHistoryRequest, GetHistoryResponse, Said
from zteleop.recording.ring import SECONDS
from zteleop.testing import Clock

ODOM = Name("abe", "odom")
ENCODING = "application/json;nav_msgs/msg/Odometry"


class Robot(fakes.Session):
    """One whose black box answers."""

    def __init__(self, *answers: GetHistoryResponse) -> None:
        super().__init__()
        self._answers = iter(answers)
        self.meanwhile: Callable[[], object] = lambda: None

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        super().ask(key, payload, encoding, seconds)
        self.meanwhile()
        answer = next(self._answers, None)
        known = codec.encoding_of(GetHistoryResponse)
        return Reply(codec.encode(answer), known, False) if answer else None

    @property
    def requests(self) -> list[GetHistoryRequest]:
        readers = codec.decoders([GetHistoryRequest])
        return [codec.decode(payload, encoding, readers) for _, payload, encoding, _ in self.asked]  # type: ignore[misc]


def page(*said: tuple[float, bytes], more: bool = False) -> GetHistoryResponse:
    return GetHistoryResponse([Said(at, "odom", ENCODING, payload) for at, payload in said], more)


def history(robot: Robot, seconds: float = 10.0) -> History:
    return History(robot, ODOM, seconds)  # type: ignore[arg-type]


def test_it_asks_on_after_what_it_has(clock: Clock) -> None:
    robot = Robot(page((1.0, b"a"), (2.0, b"b"), more=True), page((2.0, b"c"), more=True), page((3.0, b"d")))
    found = history(robot)
    assert [sample.payload for sample in found.samples] == [b"a", b"b", b"c", b"d"]
    assert {sample.key for sample in found.samples} == {"robot/abe/odom"}
    assert [(asked.after, asked.had) for asked in robot.requests] == [(0.0, 0), (2.0, 1), (2.0, 2)]
    assert {key for key, *_ in robot.asked} == {"robot/abe/srv/blackbox/history"}


def test_one_that_has_nothing_and_promises_more_is_not_asked_for_ever(clock: Clock) -> None:
    robot = Robot(page(more=True), page((1.0, b"a")))
    assert history(robot).samples == []


def test_longer_than_it_is_kept_is_refused_and_so_is_silence(clock: Clock) -> None:
    with pytest.raises(BusError, match="a black box keeps 60 s, found 61"):
        history(Robot(), SECONDS + 1)
    with pytest.raises(BusError, match="nobody serves"):
        history(Robot())


@pytest.mark.parametrize("late", [False, True])
def test_what_came_while_it_asked_is_shown_once(clock: Clock, late: bool) -> None:
    """And what says the same later is shown again."""
    robot = Robot(page((1.0, b"old"), (6.0, b"same"), (6.1, b"both")))
    ears = Listening("echo", robot)  # type: ignore[arg-type]
    ring = robot.subscribe(ODOM.key, 1)
    shown: list[bytes] = []

    def show(arrival: Arrival) -> None:
        shown.append(arrival.sample.payload)
        if arrival.sample.payload == b"new":
            ears.loop.stop()

    def meanwhile() -> None:
        clock.pass_by(0.5)
        ring.samples.extend(
            put(payload, encoding=ENCODING, key=ODOM.key) for payload in (b"same", b"both", b"both", b"new")
        )

    robot.meanwhile = meanwhile
    ears.hear(ODOM, show, 10.0)
    if late:
        clock.pass_by(OVERLAP + 0.1)
    ears.loop.run()
    ears.close()
    old = [b"old", b"same", b"both"]
    assert shown == old + ([b"same", b"both", b"both", b"new"] if late else [b"both", b"new"])


def test_where_there_is_no_history_it_is_said_and_what_is_new_is_shown(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    robot, shown = Robot(), list[bytes]()
    ears = Listening("echo", robot)  # type: ignore[arg-type]
    robot.subscribe(ODOM.key, 1).samples.append(put(b"new", encoding=ENCODING, key=ODOM.key))

    def show(arrival: Arrival) -> None:
        shown.append(arrival.sample.payload)
        ears.loop.stop()

    ears.hear(ODOM, show, 10.0)
    ears.loop.run()
    ears.close()
    assert shown == [b"new"]
    assert capsys.readouterr().err == "zteleop echo: no history: nobody serves /abe/blackbox/history here\n"
