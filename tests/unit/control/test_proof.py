import pytest

from zteleop.control.proof import LAPSE, NEVER, Prover
from zteleop.messages import Beat


def beat(time: float, epoch: int = 1, floor: float = 0.0) -> Beat:
    return Beat(epoch, time, floor)


def test_a_proof_echoes_the_newest_beat_and_counts() -> None:
    prover = Prover(7)
    prover.act(beat(10.0))
    first = prover.prove(beat(10.0), True, 0.0)
    second = prover.prove(beat(10.1), True, 0.1)
    assert first == (7, 1, 1, 10.0, 10.0, 10.0)
    assert second == (7, 2, 1, 10.1, 10.0, 10.0)


def test_a_claim_begins_when_it_leaves_neutral() -> None:
    prover = Prover(7)
    prover.act(beat(10.0))
    prover.prove(beat(10.0), False, 0.0)
    prover.act(beat(11.0))
    assert prover.prove(beat(11.0), True, 1.0).began == 11.0


def test_a_claim_begins_anew_after_silence() -> None:
    prover = Prover(7, silence=0.5)
    for time in (10.0, 10.4, 11.0):
        prover.act(beat(time))
        proof = prover.prove(beat(time), True, time)
    assert proof.began == 11.0


@pytest.mark.parametrize("slept", [0.6, LAPSE, 60.0])
def test_a_process_that_stood_still_has_not_paused(slept: float) -> None:
    prover, woke = Prover(7, silence=0.5), 10.1 + slept
    for time, awake_since in ((10.0, NEVER), (woke + 0.01, woke), (woke + 0.3, woke)):
        prover.act(beat(time))
        proof = prover.prove(beat(time), True, time, awake_since)
    assert proof.began == 10.0, "it goes on, if it still may"
    prover.act(beat(woke + 1.0))
    assert prover.prove(beat(woke + 1.0), True, woke + 1.0, woke).began == woke + 1.0, (
        "a pause after that is one"
    )


def test_a_claim_that_was_moving_before_the_robot_started_has_no_beginning() -> None:
    prover = Prover(7)
    prover.act(None)
    assert prover.prove(None, True, 0.0) is None
    prover.act(beat(10.0))
    assert prover.prove(beat(10.0), True, 0.1).began == NEVER
    prover.act(beat(10.1))
    prover.prove(beat(10.1), False, 0.2)
    prover.act(beat(10.2))
    assert prover.prove(beat(10.2), True, 0.3).began == 10.2


def test_a_new_epoch_forgets_act_and_beginning() -> None:
    prover = Prover(7)
    prover.act(beat(10.0, epoch=1))
    prover.prove(beat(10.0, epoch=1), True, 0.0)
    proof = prover.prove(beat(3.0, epoch=2), True, 0.1)
    assert (proof.epoch, proof.acted, proof.began) == (2, NEVER, NEVER)
    prover.act(beat(3.1, epoch=2))
    assert prover.prove(beat(3.1, epoch=2), True, 0.2).began == NEVER


@pytest.mark.parametrize("pause", [0.6, 1.0, LAPSE])
def test_however_slow_a_stream_does_not_begin_anew_after_a_release(pause: float) -> None:
    prover = Prover(7, silence=0.5)
    for time in (10.0, 10.0 + pause, 10.0 + 2 * pause):
        prover.act(beat(time, floor=10.5))
        proof = prover.prove(beat(time, floor=10.5), True, time)
    assert proof.began == 10.0


def test_however_slow_a_stream_does_not_begin_anew_after_a_start() -> None:
    prover = Prover(7, silence=0.5)
    for time, epoch in ((10.0, 1), (11.0, 1), (12.0, 2), (13.0, 2)):
        prover.act(beat(time, epoch))
        proof = prover.prove(beat(time, epoch), True, time)
    assert proof.began == NEVER


@pytest.mark.parametrize("pause", [LAPSE + 0.1, 60.0])
def test_after_a_release_a_pause_that_nobody_takes_for_a_stream_begins_anew(pause: float) -> None:
    prover = Prover(7, silence=0.5)
    for time in (10.0, 10.0 + pause):
        prover.act(beat(time, floor=10.05))
        proof = prover.prove(beat(time, floor=10.05), True, time)
    assert proof.began == 10.0 + pause


def test_a_claim_that_is_let_go_begins_anew() -> None:
    prover = Prover(7)
    for time in (10.0, 10.1):
        prover.act(beat(time))
        prover.prove(beat(time), True, time)
        prover.let_go()
    prover.act(beat(10.2))
    assert prover.prove(beat(10.2), True, 10.2).began == 10.2
