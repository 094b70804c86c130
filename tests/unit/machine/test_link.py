import os
import socket
from collections.abc import Iterator

import msgspec
import pytest

from zteleop.control.standing import Standing
from zteleop.errors import DeviceError
from zteleop.machine import link
from zteleop.machine.link import CUT, HEARS, HEARS_NOT, ActuatorEnd, Report, WatchdogEnd, Words
from zteleop.messages import Stop

MORE_THAN_FITS = 20_000
STOPPED = Stop(engaged=True, id=5, by="ann", why="the cat")
TEXT = msgspec.json.encode(STOPPED)
SIZE = link._REPORT.size


def report(number: int) -> Report:
    return Report(1000.0 + number, Standing(number, 999.5, 999.5, 999.5))


def packed(number: int) -> bytes:
    said = report(number)
    return link._REPORT.pack(said.stepped, said.stopped, *said.standing)


class Ends:
    def __init__(self) -> None:
        self.dog, theirs = link.pair()
        self.actuator = link.adopt(theirs.detach())


@pytest.fixture
def ends() -> Iterator[Ends]:
    ends = Ends()
    yield ends
    ends.dog.close()
    ends.actuator.close()


def test_a_report_arrives_as_it_was_said(ends: Ends) -> None:
    said = Report(16431.502, Standing(2**53 - 1, 12.25, 13.5, 14.75, 3, -1, 15.0, 16431.5))
    ends.actuator.report(said)
    assert ends.dog.read() == said


def test_nothing_said_is_nothing_and_no_end(ends: Ends) -> None:
    assert ends.dog.read() is None
    assert ends.actuator.read() == Words(None)


def test_of_several_reports_the_newest_counts(ends: Ends) -> None:
    for number in range(5):
        ends.actuator.report(report(number))
    assert ends.dog.read() == report(4)
    assert ends.dog.read() is None


@pytest.mark.parametrize("torn", [1, 8, SIZE - 1, SIZE, SIZE + 1, 2 * SIZE - 1])
def test_a_torn_report_waits_for_its_rest(torn: int) -> None:
    ours, theirs = socket.socketpair()
    dog = WatchdogEnd(ours)
    data = packed(1) + packed(2)
    theirs.send(data[:torn])
    assert dog.read() == (report(1) if torn >= SIZE else None)
    theirs.send(data[torn:])
    assert dog.read() == report(2)
    dog.close()
    theirs.close()


def test_a_frozen_watchdog_neither_blocks_nor_tears_what_it_reads_later(ends: Ends) -> None:
    for number in range(MORE_THAN_FITS):
        ends.actuator.report(report(number))
    heard = []
    while newest := ends.dog.read():
        heard.append(newest)
    assert heard == [report(found.standing.epoch) for found in heard]
    assert heard[-1].standing.epoch < MORE_THAN_FITS - 1, "the test never filled the link"
    ends.actuator.report(report(7))
    assert ends.dog.read() == report(7)


def test_a_frozen_actuator_never_blocks_the_watchdog(ends: Ends) -> None:
    for _ in range(MORE_THAN_FITS):
        ends.dog.send(HEARS)
    assert ends.actuator.read() == Words(True)


@pytest.mark.parametrize(("word", "hears"), [(HEARS, True), (HEARS_NOT, False)])
def test_the_last_word_counts_and_no_stop_is_lost_among_them(ends: Ends, word: bytes, hears: bool) -> None:
    ends.dog.send(HEARS_NOT)
    ends.dog.stop(STOPPED)
    ends.dog.send(word)
    assert ends.actuator.read() == Words(hears, (STOPPED,))


def test_every_stop_of_several_arrives(ends: Ends) -> None:
    stops = tuple(Stop(True, number, "ann", "x" * 200) for number in range(5))
    for stop in stops:
        ends.dog.stop(stop)
    assert ends.actuator.read() == Words(None, stops)


@pytest.mark.parametrize("first", range(1, 12))
def test_a_stop_that_arrives_in_pieces_is_one_stop(ends: Ends, first: int) -> None:
    said = b"s" + len(TEXT).to_bytes(2, "little") + TEXT
    ends.dog._send(said[:first])
    assert ends.actuator.read() == Words(None)
    ends.dog._send(said[first:] + HEARS)
    assert ends.actuator.read() == Words(True, (STOPPED,))


def test_the_actuators_end_is_noticed_after_its_last_report(ends: Ends) -> None:
    ends.actuator.report(report(1))
    ends.actuator.close()
    assert ends.dog.read() == report(1)
    with pytest.raises(EOFError):
        ends.dog.read()
    ends.dog.send(HEARS)


def test_the_watchdogs_end_is_noticed_in_words(ends: Ends) -> None:
    ends.dog.close()
    with pytest.raises(DeviceError, match="the watchdog is gone; the actuator does not run without one"):
        ends.actuator.read()
    ends.actuator.report(report(1))


def test_a_reset_is_an_end_too(ends: Ends) -> None:
    ends.actuator.report(report(1))
    ends.dog.close()  # with a report unread
    with pytest.raises(DeviceError, match="gone"):
        ends.actuator.read()


def test_no_other_process_inherits_an_end() -> None:
    dog, theirs = link.pair()
    assert not os.get_inheritable(dog.fileno())
    assert not os.get_inheritable(theirs.fileno())
    dog.close()
    theirs.close()


def test_the_socket_can_be_adopted_by_its_number() -> None:
    dog, theirs = link.pair()
    actuator = link.adopt(theirs.detach())
    assert isinstance(actuator, ActuatorEnd)
    actuator.report(report(3))
    assert dog.read() == report(3)
    actuator.close()
    dog.close()


@pytest.mark.parametrize("text", [b"", b"{}", b"\xff", b'{"by":"\xff"}', b"[" * 5000, TEXT + b"}"])
def test_a_stop_that_cannot_be_read_ends_the_actuator_in_words(ends: Ends, text: bytes) -> None:
    ends.dog._send(b"s" + len(text).to_bytes(2, "little") + text)
    with pytest.raises(DeviceError, match="the watchdog's stop cannot be read; the actuator ends, at rest"):
        [ends.actuator.read() for _ in range(3)]


@pytest.mark.parametrize("word", [HEARS, HEARS_NOT])
def test_with_whether_it_hears_the_watchdog_says_whether_it_has_cut_the_outputs(
    ends: Ends, word: bytes
) -> None:
    ends.dog.send(CUT[word])
    assert ends.actuator.read() == Words(word == HEARS, cut=True)
    ends.dog.send(CUT[word])
    ends.dog.send(word)
    assert ends.actuator.read() == Words(word == HEARS, cut=False)
