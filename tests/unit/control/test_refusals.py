from zteleop.control.gate import Refusal
from zteleop.control.refusals import FORGOTTEN_AFTER, NAMED, SENDERS, TOLD_AFTER, LastRefusals, RefusedSenders

STALE, EARLIER = Refusal.STALE, Refusal.EARLIER_START


def stream(
    senders: RefusedSenders, since: float, until: float, refusal: Refusal | None = STALE, sender: int = 7
) -> None:
    """Say ten commands a second."""
    for tenth in range(round(since * 10), round(until * 10) + 1):
        senders.note(sender, "program", refusal, tenth / 10)


def test_while_all_is_well_there_is_nothing_to_say() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 3.0, None)
    assert senders.news(3.0) is None


def test_a_refusal_is_told_when_it_has_lasted() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 1.0 + TOLD_AFTER)
    assert senders.news(1.0 + TOLD_AFTER) is None
    told = senders.news(1.01 + TOLD_AFTER)
    assert told
    assert told[7] == ("program", STALE, 1.0, 1.0 + TOLD_AFTER)


def test_one_command_that_counts_begins_it_again() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 1.4)
    senders.note(7, "program", None, 1.45)
    stream(senders, 1.5, 1.9)
    assert senders.news(1.95) is None


def test_another_reason_is_the_same_refusal_in_new_words() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 1.4)
    stream(senders, 1.5, 1.6, EARLIER)
    told = senders.news(1.6)
    assert told
    assert (told[7].why, told[7].since) == (EARLIER, 1.0)


def test_whoever_was_told_hears_once_that_he_counts_again() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 2.0)
    assert senders.news(2.0)
    senders.note(7, "program", None, 2.1)
    assert senders.news(2.2) == {}
    assert senders.news(2.4) is None


def test_whoever_falls_silent_is_forgotten_and_not_told_that_he_counts() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 2.0)
    assert senders.news(2.0 + FORGOTTEN_AFTER)
    assert senders.news(2.01 + FORGOTTEN_AFTER) is None
    stream(senders, 5.5, 5.6)
    assert senders.news(5.7) is None


def test_a_command_after_silence_is_a_new_refusal_although_nobody_looked_meanwhile() -> None:
    senders = RefusedSenders()
    stream(senders, 1.0, 1.0)
    stream(senders, 5.0, 5.0)
    assert senders.news(5.1) is None


def test_one_a_second_is_told() -> None:
    """The default of `zteleop pub`."""
    senders = RefusedSenders()
    senders.note(7, "program", STALE, 1.0)
    assert senders.news(1.6)


def test_a_crowd_is_bounded_and_leaves_room_when_it_is_silent() -> None:
    senders = RefusedSenders()
    for sender in range(2 * SENDERS):
        senders.note(sender, "program", STALE, 1.0)
    told = senders.news(1.6)
    assert told
    assert sorted(told) == list(range(SENDERS))
    stream(senders, 3.0, 4.0, sender=999)
    assert list(senders.news(4.0) or {}) == [999]


def test_a_crowd_that_nobody_looks_at_leaves_room_as_well() -> None:
    senders = RefusedSenders()
    for sender in range(SENDERS):
        senders.note(sender, "program", STALE, 1.0)
    stream(senders, 3.0, 4.0, sender=999)
    assert list(senders.news(4.0) or {}) == [999]


def test_refusals_in_a_row_are_one_while_sender_and_reason_are_the_same() -> None:
    refused = LastRefusals()
    for at, sender in ((1.0, 7), (1.1, 7), (1.2, 8), (1.3, 8), (1.4, 8)):
        refused.note("program", sender, Refusal.STALE, at)
    refused.note("program", 7, Refusal.STALE, 1.5)
    assert [*refused.recent(1.5, 10.0).items()] == [
        (("program", 8), (8, STALE, 1.2, 1.4, 3)),
        (("program", 7), (7, STALE, 1.0, 1.5, 3)),
    ], "two beside each other are counted each, and the newest is the last"


def test_no_more_are_named_than_anybody_reads() -> None:
    refused = LastRefusals()
    for sender in range(NAMED + 3):
        refused.note("program", sender, STALE, 1.0)
    assert [sender for _, sender in refused.recent(1.5, 10.0)] == list(range(3, NAMED + 3))
    assert refused.count == NAMED + 3


def test_whoever_was_refused_for_what_is_over_is_forgotten() -> None:
    refused = LastRefusals()
    refused.note("keyboard", 7, Refusal.AT_REST, 1.0)
    refused.note("program", 8, Refusal.STALE, 1.0)
    refused.forget(Refusal.AT_REST)
    assert list(refused.recent(1.5, 10.0)) == [("program", 8)]
    assert refused.count == 2


def test_a_sender_that_is_refused_is_not_silent() -> None:
    refused = LastRefusals()
    refused.note("program", 7, Refusal.STALE, 5.0)
    assert refused.silence("program", 7, 1.0, 6.0) == 1.0
    assert refused.silence("program", 7, 5.5, 6.0) == 0.5
    assert refused.silence("program", 8, 1.0, 6.0) == 5.0
