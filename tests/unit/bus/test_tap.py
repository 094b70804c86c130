from typing import Any

import pytest
from unit.bus.fakes import Ring, Sample, Session, put

from zteleop.bus import tap as module
from zteleop.bus.tap import Raw, Tap
from zteleop.testing import Clock

PREFIX = "robot/archangel/"


class Tapped:
    def __init__(self) -> None:
        self.session: Any = Session()
        self.tap = Tap(self.session, "archangel", ["stop", "beat"])

    def announce(self, *paths: str, process: str = "host-1", is_put: bool = True) -> None:
        keys = [f"{PREFIX}live/pub/nose/{process}/any/{path}" for path in paths]
        self.session.comings.samples.extend(put(b"", key=key, is_put=is_put) for key in keys)

    def say(self, path: str, *samples: Sample) -> None:
        self.session.rings[PREFIX + path].samples.extend(samples)

    def paths(self) -> list[str]:
        return [raw.path for raw in self.tap.take()]


@pytest.fixture
def bench(clock: Clock) -> Tapped:
    return Tapped()


def test_a_message_is_taken_in_its_bytes(bench: Tapped, clock: Clock) -> None:
    bench.say("stop", put(b"\xff", "text/plain", f"{PREFIX}stop", b"proof"))
    assert list(bench.tap.take()) == [Raw(clock.time, "stop", "text/plain", b"\xff", b"proof", False)]


def test_without_an_attachment_there_are_no_bytes_of_it(bench: Tapped) -> None:
    bench.say("stop", put(b"", key=f"{PREFIX}stop"))
    assert next(bench.tap.take()).attachment == b""


def test_a_delete_is_told_apart(bench: Tapped) -> None:
    bench.say("stop", put(b"", key=f"{PREFIX}stop", is_put=False))
    assert next(bench.tap.take()).deleted


def test_what_a_node_says_that_it_publishes_is_heard_from_then_on(bench: Tapped) -> None:
    bench.announce("lidar/front", "lidar/front", "stop")
    assert bench.paths() == []
    bench.say("lidar/front", put(b"", key=f"{PREFIX}lidar/front"))
    assert bench.paths() == ["lidar/front"]


def test_a_path_that_nobody_publishes_on_any_more_gives_its_place_back(bench: Tapped) -> None:
    for process in ("host-1", "host-2"):
        bench.announce("lidar/front", process=process)
    assert bench.paths() == []
    for process, held in (("host-1", True), ("host-2", False)):
        bench.announce("lidar/front", process=process, is_put=False)
        bench.say("lidar/front", put(b"", key=f"{PREFIX}lidar/front"))
        assert bench.paths() == ["lidar/front"], "its last words count"
        assert bench.session.rings[f"{PREFIX}lidar/front"].declared is held


def test_a_known_path_is_heard_whoever_publishes(bench: Tapped) -> None:
    bench.announce("stop")
    assert bench.paths() == []
    bench.announce("stop", is_put=False)
    assert bench.paths() == []
    assert bench.session.rings[f"{PREFIX}stop"].declared


def test_what_nobody_announced_is_not_asked_for(bench: Tapped) -> None:
    bench.announce("lidar/*", "cmd_vel/++")
    assert bench.paths() == []
    assert set(bench.session.rings) == {f"{PREFIX}stop", f"{PREFIX}beat"}


def test_announcements_without_end_are_not_all_heard(bench: Tapped) -> None:
    bench.announce(*(f"chatter_{number}" for number in range(100)))
    assert bench.paths() == []
    assert len(bench.session.rings) == module.MOST


def test_a_wildcard_is_taken_under_its_whole_key(bench: Tapped) -> None:
    keys = ["robot/*/stop", f"{PREFIX}*", f"{PREFIX}**"]
    bench.say("stop", *(put(b"", key=key) for key in keys))
    assert bench.paths() == keys


def test_a_flood_leaves_the_others_their_turn(bench: Tapped) -> None:
    class Endless(Ring):
        def try_recv(self) -> Sample:
            return put(b"", key=f"{PREFIX}stop")

    bench.tap._inboxes["stop"] = Endless()
    bench.say("beat", put(b"", key=f"{PREFIX}beat"))
    assert bench.paths() == ["stop"] * module.DEPTH + ["beat"]


def test_what_was_commanded_is_told_before_what_came_of_it_however_they_arrive(bench: Tapped) -> None:
    bench.announce("drive_status", "pwm/keyboard")
    assert bench.paths() == []

    class Late(Ring):
        """Somebody is commanded, and says so, while the box looks at what was said."""

        def try_recv(self) -> Sample | None:
            said = super().try_recv()
            if said:
                bench.say("pwm/keyboard", put(b"", key=f"{PREFIX}pwm/keyboard"))
            return said

    bench.tap._inboxes["drive_status"] = Late(put(b"", key=f"{PREFIX}drive_status"))
    bench.say("beat", put(b"", key=f"{PREFIX}beat"))
    assert bench.paths() == ["pwm/keyboard", "beat", "drive_status"]


def test_a_flooded_path_is_not_heard_for_a_while_and_then_again(bench: Tapped, clock: Clock) -> None:
    said = put(b"", key=f"{PREFIX}stop")
    bench.say("stop", *[said] * module.FLOOD)
    assert bench.paths() == ["stop"] * module.FLOOD
    assert not bench.session.rings[f"{PREFIX}stop"].declared
    clock.pass_by(module.PAUSE - 0.1)
    bench.say("stop", said)
    assert bench.paths() == []
    clock.pass_by(0.2)
    assert bench.paths() == ["stop"]
    assert bench.session.rings[f"{PREFIX}stop"].declared


def test_what_came_first_is_told_first_where_the_door_took_note(bench: Tapped, clock: Clock) -> None:
    bench.announce("drive_status", "pwm/keyboard")
    assert bench.paths() == []
    for path, at in (("pwm/keyboard", 2.0), ("pwm/keyboard", 4.0), ("drive_status", 3.0), ("beat", 1.0)):
        bench.say(path, put(b"", key=f"{PREFIX}{path}")._replace(at=at))
    told = [(raw.path, raw.at) for raw in bench.tap.take()]
    assert told == [("beat", 1.0), ("pwm/keyboard", 2.0), ("drive_status", 3.0), ("pwm/keyboard", 4.0)]
