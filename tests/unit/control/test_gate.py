import pytest

from zteleop.control.deadlines import Deadlines
from zteleop.control.gate import SENDERS, Gate, Refusal
from zteleop.control.proof import Proof

EPOCH = 5


@pytest.fixture
def gate() -> Gate:
    return Gate(Deadlines(), EPOCH, now=100.0)


def proof(now: float, seq: int = 1, **changes: float) -> Proof:
    fields = {"sender": 1, "seq": seq, "epoch": EPOCH, "beat": now, "acted": now, "began": now}
    return Proof(**(fields | changes))  # type: ignore[arg-type]


def test_a_fresh_act_from_neutral_passes(gate: Gate) -> None:
    assert gate.judge(proof(101.0), True, 101.01) is None


def test_no_proof_no_motion(gate: Gate) -> None:
    assert gate.judge(None, True, 101.0) is Refusal.UNPROVEN


def test_another_epoch_is_refused(gate: Gate) -> None:
    assert gate.judge(proof(101.0, epoch=4), True, 101.0) is Refusal.EARLIER_START


@pytest.mark.parametrize(("age", "verdict"), [(0.3, None), (0.31, Refusal.STALE), (-0.01, Refusal.STALE)])
def test_age_is_bounded_both_ways(gate: Gate, age: float, verdict: Refusal | None) -> None:
    made = 101.0
    assert gate.judge(proof(made), False, made + age) is verdict


def test_neither_seq_nor_beat_goes_back(gate: Gate) -> None:
    assert gate.judge(proof(101.0, seq=5), True, 101.0) is None
    assert gate.judge(proof(101.1, seq=5), True, 101.1) is Refusal.REPLAYED
    assert gate.judge(proof(100.9, seq=6), True, 101.1) is Refusal.REPLAYED


def test_an_idle_operator_is_refused_and_the_next_act_drives_again(gate: Gate) -> None:
    for tick in range(300):
        now = 101.0 + tick / 20
        verdict = gate.judge(proof(now, seq=tick, acted=101.0, began=101.0), True, now)
        assert verdict is (None if now - 101.0 <= 5.0 else Refusal.OPERATOR_IDLE)
    assert gate.judge(proof(117.0, seq=900, began=101.0), True, 117.0) is None


def test_what_began_before_the_start_is_refused(gate: Gate) -> None:
    assert gate.judge(proof(101.0, began=100.0), True, 101.0) is Refusal.NOT_FROM_NEUTRAL
    assert gate.judge(proof(101.1, seq=2, began=99.0), False, 101.1) is None


def test_a_short_loss_resumes_and_a_long_one_needs_a_new_act_from_neutral(gate: Gate) -> None:
    assert gate.judge(proof(101.0, seq=1), True, 101.0) is None
    assert gate.judge(proof(102.9, seq=2, began=101.0), True, 102.9) is None
    assert gate.judge(proof(105.0, seq=3, began=101.0), True, 105.0) is Refusal.LAPSED
    assert gate.judge(proof(105.1, seq=4, began=101.0), True, 105.1) is Refusal.LAPSED
    assert gate.judge(proof(105.2, seq=5, began=105.2), True, 105.2) is None


def test_letting_go_before_a_silence_is_no_loss(gate: Gate) -> None:
    assert gate.judge(proof(101.0, seq=1), False, 101.0) is None
    assert gate.judge(proof(109.0, seq=2), True, 109.0) is None


def test_a_claim_that_was_not_heard_for_long_needs_a_new_act_from_neutral(gate: Gate) -> None:
    """It was pressed when the link was already lost, and is held when the link comes back."""
    assert gate.judge(proof(101.0, seq=1), False, 101.0) is None
    assert gate.judge(proof(103.9, seq=2, began=101.5), True, 103.9) is Refusal.LAPSED
    assert gate.judge(proof(104.0, seq=3, began=101.5), True, 104.0) is Refusal.LAPSED
    assert gate.judge(proof(104.1, seq=4, began=104.1), True, 104.1) is None
    assert gate.judge(proof(104.0, sender=2, began=101.5), True, 104.0) is Refusal.LAPSED
    assert gate.judge(proof(104.0, sender=3, began=102.5), True, 104.0) is None


def test_of_a_lost_link_the_first_two_seconds_are_no_beginning(gate: Gate) -> None:
    assert gate.judge(proof(101.0, seq=1), True, 101.0) is None
    assert gate.judge(proof(104.0, seq=2, began=102.9), True, 104.0) is Refusal.LAPSED
    assert gate.judge(proof(104.1, seq=3, began=103.1), True, 104.1) is None


def test_a_beginning_that_is_heard_at_once_is_one_even_within_them(gate: Gate) -> None:
    """Whoever paused for just two seconds begins by the beat heard last, which is a little older."""
    assert gate.judge(proof(101.0, seq=1), True, 101.0) is None
    assert gate.judge(proof(103.05, seq=2, began=102.95), True, 103.05) is None
    assert gate.judge(proof(103.10, seq=3, began=102.95), True, 103.10) is None


def test_only_what_begins_after_a_rest_counts(gate: Gate) -> None:
    gate.begin_after(102.0)
    gate.begin_after(101.5)
    assert gate.judge(proof(102.1, began=102.0), True, 102.1) is Refusal.NOT_FROM_NEUTRAL
    assert gate.judge(proof(102.2, seq=2, began=102.1), True, 102.2) is None


def test_a_second_opinion_is_never_the_stricter_one() -> None:
    gate = Gate(Deadlines(), EPOCH, 100.0, grace=0.25)
    assert gate.judge(proof(100.1, began=99.8), True, 100.1) is None
    gate.begin_after(101.0)
    assert gate.judge(proof(101.1, seq=2, began=100.8), True, 101.1) is None
    assert gate.judge(proof(103.3, seq=3, began=100.8), True, 103.3) is None
    assert gate.judge(proof(105.6, seq=4, began=103.4), True, 105.6) is None
    assert gate.judge(proof(108.0, seq=5, began=103.4), True, 108.0) is Refusal.LAPSED


def test_a_restart_refuses_all_that_was_before(gate: Gate) -> None:
    assert gate.judge(proof(101.0), True, 101.0) is None
    gate.restart(6, 102.0)
    assert gate.judge(proof(102.1, seq=2), True, 102.1) is Refusal.EARLIER_START
    assert gate.judge(proof(102.1, seq=3, epoch=6, began=101.0), True, 102.1) is Refusal.NOT_FROM_NEUTRAL
    assert gate.judge(proof(102.2, seq=4, epoch=6), True, 102.2) is None


def test_nonsense_times_are_refused(gate: Gate) -> None:
    nan = float("nan")
    assert gate.judge(proof(101.0, beat=nan), True, 101.0) is Refusal.STALE
    assert gate.judge(proof(101.0, acted=nan), True, 101.0) is Refusal.LAPSED
    assert gate.judge(proof(101.0, seq=2, began=nan), True, 101.0) is Refusal.LAPSED
    assert gate.judge(proof(101.0, seq=3, began=200.0), True, 101.0) is Refusal.LAPSED


def test_memory_is_bounded_and_the_forgotten_must_let_go(gate: Gate) -> None:
    assert gate.judge(proof(101.0, seq=9), True, 101.0) is None
    for sender in range(2, SENDERS + 3):
        now = 101.0 + sender / 1000
        assert gate.judge(proof(now, sender=sender), True, now) is None
    assert len(gate._senders) == SENDERS
    assert gate.judge(proof(101.2, seq=10, began=101.0), True, 101.2) is Refusal.LAPSED


def test_whoever_drives_is_not_forgotten_for_strangers_who_never_did(gate: Gate) -> None:
    driver = proof(101.0)
    assert gate.judge(driver, True, 101.0) is None
    gate.count(driver, 101.0)
    for sender in range(2, 5 * SENDERS):
        now = 101.0 + sender / 4000
        assert gate.judge(proof(now, sender=sender), False, now) is None
    assert len(gate._senders) == SENDERS
    assert gate.judge(proof(101.2, seq=10, began=101.0), True, 101.2) is None


def test_whoever_drove_long_ago_is_forgotten_like_anybody(gate: Gate) -> None:
    for sender in range(1, SENDERS + 1):
        drove = proof(101.0, sender=sender)
        assert gate.judge(drove, True, 101.0) is None
        gate.count(drove, 101.0)
    late = proof(110.0, sender=SENDERS + 1)
    assert gate.judge(late, True, 110.0) is None
    assert gate.judge(late._replace(seq=2, beat=110.05), True, 110.05) is None
    assert 1 not in gate._senders


def test_however_many_come_and_go_whoever_is_remembered_drives_on(gate: Gate) -> None:
    assert gate.judge(proof(101.0), True, 101.0) is None
    for sender in range(2, 3 * SENDERS):
        now = 101.0 + sender / 100
        assert gate.judge(proof(now, sender=sender), True, now) is None
        assert gate.judge(proof(now, seq=sender, began=101.0), True, now) is None
