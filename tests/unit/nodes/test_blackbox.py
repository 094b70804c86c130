import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from zteleop.bus import codec
from zteleop.bus.tap import Raw
from zteleop.machine.sidecar import LAST_WORD
from zteleop.messages import DriveStatus, Message, Stop, WatchdogStatus
from zteleop.nodes import blackbox as module
from zteleop.nodes.blackbox import AFTERMATH, LISTENS_WITHIN, PAUSE, BlackBox, Writer
from zteleop.recording.ring import Ring, Snapshot
from zteleop.recording.triggers import Trigger
from zteleop.testing import Clock, FakeNode


class Tap:
    def __init__(self, clock: Clock) -> None:
        self._clock, self._waiting = clock, []

    def say(self, path: str, message: Message) -> None:
        kind = codec.encoding_of(type(message))
        self._waiting.append(Raw(self._clock.time, path, kind, codec.encode(message), b"", False))

    def take(self) -> Iterator[Raw]:
        while self._waiting:
            yield self._waiting.pop(0)


class Shelf:
    """A writer that keeps what it was given."""

    def __init__(self) -> None:
        self.files: list[tuple[list[str], int]] = []
        """of each file its reasons, and how many messages it has"""
        self.busy = False
        self.trouble = ""
        self.finished = 0

    def write(self, held: Snapshot, triggers: list[Trigger]) -> None:
        self.files.append(([trigger.reason for trigger in triggers], len(held.messages)))

    def finish(self) -> None:
        self.finished += 1


class Recorded:
    """A black box, with the watchdog's end of its pipe."""

    def __init__(self, node: FakeNode, clock: Clock) -> None:
        self.node, self.clock, self.tap, self.shelf = node, clock, Tap(clock), Shelf()
        self.ear, self.mouth = os.pipe()
        self.warnings: list[str] = []
        ring: Any = Ring(["stop", "drive_status"])
        self.box = BlackBox(
            node,
            self.tap,
            ring,
            self.shelf,
            self.ear,
            self.warnings.append,  # type: ignore[arg-type]
        )
        node.loop.watch(self.ear, self.box._hear_watchdog)
        node.every(LISTENS_WITHIN)(self.box._listen)

    def live(self, seconds: float) -> None:
        self.node.live(seconds)

    def stop(self, number: int = 7) -> None:
        self.tap.say("stop", Stop(engaged=True, id=number, by="ann", why=""))

    def end(self) -> None:
        """Be told to end by a signal."""
        self.box._finish()

    def hear_watchdog(self) -> None:
        self.node.loop.watched[self.ear]()

    def close(self) -> None:
        os.close(self.ear)
        self.part()

    def part(self, word: bytes = b"") -> None:
        """Let the watchdog's end of the pipe end."""
        if self.mouth >= 0:
            os.write(self.mouth, word)
            os.close(self.mouth)
            self.mouth = -1


@pytest.fixture
def bench(node: FakeNode, clock: Clock) -> Iterator[Recorded]:
    bench = Recorded(node, clock)
    yield bench
    bench.close()


def test_while_nothing_happens_nothing_is_written(bench: Recorded) -> None:
    bench.tap.say("drive_status", DriveStatus.zero())
    bench.live(100.0)
    assert bench.shelf.files == []


def test_what_follows_a_stop_is_kept_with_it(bench: Recorded) -> None:
    bench.stop()
    bench.live(AFTERMATH - 0.1)
    assert bench.shelf.files == []
    bench.tap.say("watchdog", WatchdogStatus.zero())
    bench.live(0.2)
    assert bench.shelf.files == [(["stop"], 2)]


def test_reasons_that_follow_each_other_are_one_file(bench: Recorded) -> None:
    bench.stop(7)
    bench.live(0.5)
    bench.stop(8)
    bench.live(5.0)
    assert bench.shelf.files == [(["stop", "stop"], 2)]


def test_a_reason_soon_after_a_file_waits(bench: Recorded) -> None:
    bench.stop(7)
    bench.live(2.0)
    bench.stop(8)
    bench.live(AFTERMATH + PAUSE - 2.5)
    assert len(bench.shelf.files) == 1
    bench.stop(9)
    bench.live(1.0)
    assert bench.shelf.files[1:] == [(["stop", "stop"], 3)]


def test_while_a_disk_is_slow_nothing_else_is_written(bench: Recorded) -> None:
    bench.stop()
    bench.shelf.busy = True
    bench.live(5.0)
    assert bench.shelf.files == []
    bench.shelf.busy = False
    bench.live(0.1)
    assert len(bench.shelf.files) == 1


def test_a_disk_that_refuses_is_said_once(bench: Recorded) -> None:
    bench.shelf.trouble = "No space left on device"
    bench.live(5.0)
    assert bench.warnings == ["the black box cannot be kept: No space left on device"]


def test_a_watchdog_that_ends_without_a_word_is_a_reason_at_once(bench: Recorded) -> None:
    bench.tap.say("watchdog", WatchdogStatus.zero())
    bench.part()
    bench.hear_watchdog()
    assert bench.node.stopped
    bench.end()
    assert bench.shelf.files == [(["watchdog-ended"], 1)]
    assert bench.shelf.finished


def test_a_watchdog_that_says_farewell_is_none(bench: Recorded) -> None:
    bench.part(LAST_WORD)
    bench.hear_watchdog()
    assert bench.node.stopped
    bench.end()
    assert bench.shelf.files == []


def test_a_robot_that_ends_in_good_order_writes_what_is_due(bench: Recorded) -> None:
    bench.stop()
    bench.live(0.1)
    bench.part(LAST_WORD)
    bench.hear_watchdog()
    bench.end()
    assert bench.shelf.files == [(["stop"], 1)]


def test_a_signal_alone_is_no_reason(bench: Recorded) -> None:
    bench.end()
    assert bench.shelf.files == []


def test_a_signal_because_the_watchdog_is_gone_is_one(bench: Recorded) -> None:
    bench.part()
    bench.end()
    assert bench.shelf.files == [(["watchdog-ended"], 0)]


def test_a_signal_after_the_farewell_is_none(bench: Recorded) -> None:
    bench.part(LAST_WORD)
    bench.end()
    assert bench.shelf.files == []


def test_a_last_message_is_heard(bench: Recorded) -> None:
    bench.stop()
    bench.end()
    assert bench.shelf.files == [(["stop"], 1)]


HELD = Snapshot(
    [Raw(998.0, "lidar", "", b"1", b"", False), Raw(1001.0, "lidar", "", b"2", b"", False)], 1, {}, 3
)


def test_a_file_says_whose_it_is_when_and_why(
    tmp_path: Path, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module.time, "time", lambda: 1_700_000_001.0)
    writer = Writer("archangel", tmp_path)
    header = writer._header(
        HELD, [Trigger(999.0, "stop", "so"), Trigger(999.5, "fault", "x")], 1_699_999_001.0
    )
    assert (header.robot, header.reason, header.why, header.at) == ("archangel", "stop", "so", 999.0)
    assert header.time == "2023-11-14 22:13:20.000"
    assert (header.span, header.topics, header.elsewhere) == (3.0, 1, 3)
    assert [trigger.reason for trigger in header.triggers] == ["stop", "fault"]


def test_what_the_disk_refuses_is_kept_in_words(tmp_path: Path, clock: Clock) -> None:
    (tmp_path / "file").write_text("")
    writer = Writer("archangel", tmp_path / "file")
    writer._run(HELD, [Trigger(999.0, "stop", "so")], 0.0)
    assert writer.trouble == "File exists"
