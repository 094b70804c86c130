from zteleop.control.mux import Claim, Mux, Silences, Source
from zteleop.messages import Twist

SOURCES = {"web": Source(priority=100), "keyboard": Source(priority=90), "program": Source(50, silence=0.5)}


def claim(
    source: str, at: float, sender: int = 1, acted: float | None = None, began: float | None = None
) -> Claim:
    acted = at if acted is None else acted
    return Claim(source, sender, Twist.planar(0.5), acted, at, 1, at, acted if began is None else began)


def mux() -> Mux:
    return Mux(SOURCES, Silences(SOURCES, 5.0), link_loss=2.0)


def test_nobody_drives_at_first() -> None:
    assert mux().select(0.0) is None


def test_the_highest_priority_drives() -> None:
    it = mux()
    for source in ("program", "web", "keyboard"):
        assert it.offer(claim(source, 1.0))
    assert it.select(1.0).source == "web"
    it.offer(claim("program", 1.35))
    assert it.select(1.35).source == "program"


def test_each_source_falls_silent_by_its_own_deadline() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.0))
    it.offer(claim("program", 1.0))
    assert it.select(1.29).source == "keyboard"
    assert it.select(1.31).source == "program"
    assert it.select(1.51) is None


def test_a_deadline_that_was_shortened_holds_at_once() -> None:
    silences = Silences(SOURCES, 5.0)
    it = Mux(SOURCES, silences, link_loss=2.0)
    it.offer(claim("program", 1.0))
    silences.shorten("program", 0.2)
    assert it.select(1.19).source == "program"
    assert it.select(1.21) is None


def test_an_idle_operator_yields() -> None:
    it = mux()
    it.offer(claim("keyboard", 10.0, acted=5.0))
    assert it.select(10.0).source == "keyboard"
    it.offer(claim("keyboard", 10.1, acted=5.0))
    assert it.select(10.1) is None


def test_within_a_source_the_holder_keeps_it_until_lost_or_let_go() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.0, sender=1))
    assert not it.offer(claim("keyboard", 1.1, sender=2))
    assert not it.offer(claim("keyboard", 2.9, sender=2))  # the holder may come back, and go on
    assert it.offer(claim("keyboard", 3.1, sender=2))
    it.release(2)
    assert it.select(3.1) is None
    assert it.offer(claim("keyboard", 3.2, sender=1))


def test_whoever_waited_begins_anew_although_he_acted_all_along() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.0, sender=1))
    assert not it.offer(claim("keyboard", 1.1, sender=2))
    it.release(1)
    assert not it.offer(claim("keyboard", 1.2, sender=2, acted=1.2, began=1.05))
    assert it.offer(claim("keyboard", 1.3, sender=2, began=1.25))


def test_what_was_said_before_an_interruption_ended_is_not_obeyed_and_keeps_its_place() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.0, sender=1))
    ended = 1.2
    assert it.select(1.2, ended) is None
    assert not it.offer(claim("keyboard", 1.25, sender=2))
    it.offer(claim("keyboard", 1.3, sender=1))
    assert it.select(1.3, ended)


def test_letting_go_frees_only_ones_own() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.0, sender=1))
    it.release(2)
    assert it.select(1.0).sender == 1


def test_a_sender_that_no_longer_hears_the_robot_falls_silent_as_well() -> None:
    it = mux()
    it.offer(claim("keyboard", 1.25)._replace(beat=1.0))
    assert it.select(1.39)
    assert it.select(1.41) is None


def test_a_claim_is_not_over_at_its_end_and_is_right_after() -> None:
    silences = Silences(SOURCES, 5.0)
    for one in (
        claim("keyboard", 10.0),
        claim("program", 10.0),
        claim("keyboard", 10.0, acted=5.1),
        claim("keyboard", 10.0)._replace(beat=9.8),
    ):
        end = silences.end(one)
        assert not silences.over(one, end - 1e-6)
        assert silences.over(one, end + 1e-6)
