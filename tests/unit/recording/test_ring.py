from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.tap import Raw
from zteleop.recording import ring as module
from zteleop.recording.ring import (
    FLOOD,
    KNOWN_BYTES,
    OTHER_BYTES,
    OVERHEAD,
    SECONDS,
    TOPIC_BYTES,
    TOPICS_AT_MOST,
    Ring,
)

KNOWN = ("pwm/keyboard", "stop", "drive_status")


def raw(at: float, path: str = "stop", size: int = 10, attachment: bytes = b"") -> Raw:
    return Raw(at, path, "application/json", b"x" * size, attachment, False)


def paths(ring: Ring) -> list[str]:
    return [message.path for message in ring.snapshot().messages]


def test_messages_come_back_as_they_came_in_the_order_of_time() -> None:
    ring = Ring(KNOWN)
    said = [raw(1.0, "lidar"), raw(2.0, "stop", attachment=b"proof"), raw(3.0, "lidar")]
    for message in said:
        ring.add(message)
    assert ring.snapshot() == (said, 2, {}, 0)


def test_of_what_was_taken_at_once_the_topic_known_first_is_the_earlier() -> None:
    ring = Ring(KNOWN)
    for path in ("lidar", "drive_status", "stop", "pwm/keyboard"):
        ring.add(raw(1.0, path))
    assert paths(ring) == ["pwm/keyboard", "stop", "drive_status", "lidar"]


def test_a_message_is_kept_for_a_minute() -> None:
    ring = Ring(KNOWN)
    ring.add(raw(100.0))
    ring.add(raw(100.0 + SECONDS, "beat"))
    assert paths(ring) == ["stop", "beat"]
    ring.add(raw(100.1 + SECONDS, "beat"))
    assert paths(ring) == ["beat", "beat"]


def test_a_minute_is_one_in_which_something_was_said() -> None:
    """A robot whose processes hung for an hour before they died has still something to tell."""
    ring = Ring(KNOWN)
    ring.add(raw(100.0))
    assert paths(ring) == ["stop"]


def test_a_topic_that_fell_silent_costs_nothing_after_a_minute() -> None:
    ring = Ring(KNOWN)
    ring.add(raw(0.0, "lidar", 1000))
    ring.add(raw(2 * SECONDS))
    assert ring.size < 1000
    assert ring.snapshot().topics == 1


def test_one_topic_has_a_bound() -> None:
    ring = Ring(KNOWN)
    for number in range(30):
        ring.add(raw(number / 100, size=TOPIC_BYTES // 10))
    assert TOPIC_BYTES // 2 < ring.size <= TOPIC_BYTES
    assert ring.snapshot().messages[-1].at == 0.29


def test_a_message_larger_than_a_topics_room_is_not_the_end() -> None:
    ring = Ring(KNOWN)
    ring.add(raw(0.0, size=2 * TOPIC_BYTES // 3))
    ring.add(raw(1.0, size=2 * TOPIC_BYTES // 3))
    assert len(ring.snapshot().messages) == 1
    ring.add(raw(2.0, size=2 * TOPIC_BYTES))
    ring.add(raw(3.0, "beat"))
    assert ring.size <= TOPIC_BYTES


def test_a_flood_on_unknown_topics_costs_known_ones_nothing() -> None:
    ring = Ring(KNOWN)
    for path in KNOWN:
        ring.add(raw(0.0, path, 100_000))
    for number in range(20_000):
        ring.add(raw(number / 1000, f"junk/{number % 500}", 5000))
    assert {message.path for message in ring.snapshot().messages} >= set(KNOWN)
    assert ring.size <= OTHER_BYTES + 400_000


def test_a_flood_on_a_known_topic_leaves_the_others_theirs() -> None:
    known = [f"pwm/{number}" for number in range(30)]
    ring = Ring([*known, *KNOWN])
    for path in KNOWN:
        ring.add(raw(0.0, path, 100_000))
    for number in range(3000):
        ring.add(raw(number / 100, known[number % 30], 50_000))
    assert {message.path for message in ring.snapshot().messages} >= set(KNOWN)
    assert ring.size <= KNOWN_BYTES


def test_more_topics_than_there_is_room_for_are_counted() -> None:
    ring = Ring(KNOWN)
    for number in range(TOPICS_AT_MOST + 10):
        ring.add(raw(1.0, f"junk/{number}"))
    ring.add(raw(1.0, "stop"))
    held = ring.snapshot()
    assert held.topics == TOPICS_AT_MOST - len(KNOWN) + 1
    assert held.elsewhere == 10 + len(KNOWN)
    assert ring.snapshot().elsewhere == 0, "the next file tells of what followed"


def test_a_topic_with_an_endless_name_is_none() -> None:
    ring = Ring(KNOWN)
    ring.add(raw(1.0, "x" * 10_000))
    assert ring.snapshot() == ([], 0, {}, 1)


def test_a_flood_is_counted_by_the_second() -> None:
    ring = Ring(KNOWN)
    for number in range(3 * FLOOD):
        ring.add(raw(5 + number / (2 * FLOOD), "junk"))
    ring.add(raw(7.0))
    assert ring.snapshot().floods == {"junk": [(5, 2 * FLOOD), (6, FLOOD)]}


def test_a_flood_of_long_ago_is_not_told_of_a_topic_that_goes_on() -> None:
    ring = Ring(KNOWN)
    for _ in range(FLOOD):
        ring.add(raw(5.0, "junk"))
    for tenth in range(1, 15):
        ring.add(raw(5.0 + tenth * SECONDS / 10, "junk"))
    assert ring.snapshot().floods == {}


messages = st.tuples(
    st.floats(0, 30),
    st.sampled_from([*KNOWN, "a", "b", "c", "d", "e"]),
    st.integers(0, module.TOPIC_BYTES // 2),
)


@given(st.lists(messages, max_size=60))
def test_whatever_is_said_memory_is_bounded_and_counted(said: list[tuple[float, str, int]]) -> None:
    ring, now = Ring(KNOWN), 0.0
    for pause, path, size in said:
        now += pause
        ring.add(raw(now, path, size))
        assert ring.size <= KNOWN_BYTES + OTHER_BYTES
    held = ring.snapshot()
    assert [m.at for m in held.messages] == sorted(m.at for m in held.messages)
    assert all(m.at >= now - SECONDS for m in held.messages)
    assert ring.size == sum(OVERHEAD + len(m.payload) + len(m.encoding) for m in held.messages)
