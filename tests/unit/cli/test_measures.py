"""hz, bw and delay: what they make of messages that came at known times."""

import pytest
from unit.bus.fakes import put, sample

from zteleop.cli import bw, delay, hz
from zteleop.cli._listening import Arrival
from zteleop.errors import MessageError
from zteleop.messages import Header, String, Time, Twist, TwistStamped


def said(*times: float) -> list[Arrival]:
    return [Arrival(at, sample(String("x"))) for at in times]


def pace(*times: float, most: int = 100) -> hz.Pace:
    found = hz.Pace(most)
    for arrival in said(*times):
        found.hear(arrival)
    return found


def test_a_rate_is_told_in_the_words_of_ros() -> None:
    assert list(hz._single(pace(1.0, 1.1, 1.2, 1.4))) == [
        "average rate: 7.500",
        "\tmin: 0.100s max: 0.200s std dev: 0.04714s window: 3",
    ]


def test_of_a_window_only_the_newest_count() -> None:
    assert next(iter(hz._single(pace(0.0, 5.0, 5.5, 6.0, most=2)))) == "average rate: 2.000"


def test_what_fell_silent_is_said_and_what_never_spoke_is_not() -> None:
    spoke = pace(1.0, 2.0)
    assert len(list(hz._single(spoke))) == 2
    assert list(hz._single(spoke)) == ["no new messages"]
    assert list(hz._single(pace())) == list(hz._single(pace(1.0))) == []


def test_several_topics_are_a_table_with_those_that_are_silent() -> None:
    paces = {"/abe/odom": pace(0.0, 0.5, 1.0), "/abe/why": pace(), "/abe/log": pace(1.0, 2.0)}
    paces["/abe/log"].news()
    assert list(hz._table(paces)) == [
        "topic      rate       min_delta  max_delta  std_dev  window",
        "===========================================================",
        "/abe/odom  2.000      0.50000    0.50000    0.00000  2",
        "/abe/why   not heard",
        "/abe/log   silent",
        "",
    ]
    assert list(hz._table({"/abe/odom": pace(1.0)})) == []


def test_the_bytes_of_several_topics_are_a_table() -> None:
    sizes = {"/abe/odom": bw.Sizes(10), "/abe/why": bw.Sizes(10)}
    assert list(bw.table(sizes, 1.0)) == []
    for at in (0.0, 0.5):
        sizes["/abe/odom"].hear(Arrival(at, put(b"0123")))
    assert list(bw.table(sizes, 1.0)) == [
        "topic      rate       mean  min  max  messages",
        "==============================================",
        "/abe/odom  8 B/s      4 B   4 B  4 B  2",
        "/abe/why   not heard",
        "",
    ]


def test_the_ages_of_several_topics_are_a_table() -> None:
    delays = {"/abe/odom": delay.Delays(10), "/abe/why": delay.Delays(10)}
    assert list(delay.table(delays)) == []
    delays["/abe/odom"].hear(
        Arrival(0.0, sample(TwistStamped(Header(Time(100, 0), ""), Twist.zero()))), 100.25
    )
    assert list(delay.table(delays)) == [
        "topic      delay      min    max    std_dev  window",
        "===================================================",
        "/abe/odom  0.250      0.250  0.250  0.00000  1",
        "/abe/why   not heard",
        "",
    ]
    assert list(delay.table(delays))[2].split() == ["/abe/odom", "silent"]


@pytest.mark.parametrize(
    ("size", "count", "lines"),
    [
        (10, 5, ["50 B/s from 5 messages", "\tMessage size mean: 10 B min: 10 B max: 10 B"]),
        (
            1000,
            5,
            ["5.00 KB/s from 5 messages", "\tMessage size mean: 1.00 KB min: 1.00 KB max: 1.00 KB"],
        ),
        (
            10**6,
            4,
            ["4.00 MB/s from 4 messages", "\tMessage size mean: 1.00 MB min: 1.00 MB max: 1.00 MB"],
        ),
    ],
)
def test_a_bandwidth_has_the_unit_that_suits_it(size: int, count: int, lines: list[str]) -> None:
    sizes = bw.Sizes(100)
    for number in range(count):
        sizes.hear(Arrival(number / count, put(b"x" * size)))
    assert list(sizes.lines(1.0)) == lines


def test_a_topic_that_fell_silent_has_no_rate() -> None:
    sizes = bw.Sizes(2)
    for at in (0.0, 1.0, 2.0):
        sizes.hear(Arrival(at, put(b"x" * 10)))
    assert next(iter(sizes.lines(3.0))) == "10 B/s from 2 messages"
    assert list(sizes.lines(21.0)) == ["no new messages"]
    assert list(bw.Sizes(2).lines(1.0)) == []
    silent, speaks = bw.Sizes(9), bw.Sizes(9)
    for at in (0.0, 1.0):
        silent.hear(Arrival(at, put(b"x")))
        speaks.hear(Arrival(at, put(b"x")))
    both = {"/a/silent": silent, "/a/speaks": speaks}
    assert list(bw.table(both, 2.0))[2].split()[:3] == ["/a/silent", "1", "B/s"]
    speaks.hear(Arrival(2.0, put(b"x")))
    assert list(bw.table(both, 3.0))[2].split() == ["/a/silent", "silent"]
    speaks.hear(Arrival(3.0, put(b"x")))
    assert list(bw.table(both, 4.0))[3].split()[:3] == ["/a/speaks", "1", "B/s"]


def test_a_delay_is_from_the_stamp_to_the_arrival() -> None:
    delays = delay.Delays(100)
    for sec, today in ((10, 10.75), (20, 20.25)):
        stamped = TwistStamped(Header(Time(sec, 250_000_000), "base_link"), Twist.zero())
        delays.hear(Arrival(0.0, sample(stamped)), today)
    assert list(delays.lines()) == [
        "average delay: 0.250",
        "\tmin: 0.000s max: 0.500s std dev: 0.25000s window: 2",
    ]
    assert list(delays.lines()) == ["no new messages"]


@pytest.mark.parametrize("bad", [sample(Twist.zero()), put(b"[]", encoding="application/json")])
def test_a_message_that_does_not_say_when_it_was_made_has_no_delay(bad: object) -> None:
    delays = delay.Delays(100)
    with pytest.raises(MessageError, match="msg does not have header"):
        delays.hear(Arrival(0.0, bad), 1.0)
    assert list(delays.lines()) == []
