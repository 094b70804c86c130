import msgspec

from zteleop.chaos.certificate import HEAD, Certificate, certify, verdict
from zteleop.chaos.fault import Fault
from zteleop.chaos.trial import Outcome

STRUCK = Fault("wheel falls off", lambda bench: None, 0.05)
HARMLESS = Fault("bell rings", lambda bench: None, None, "drives")


def test_a_fault_that_kept_its_bound() -> None:
    found = verdict("parts", STRUCK, [Outcome(0.003), Outcome(0.001), Outcome(0.004)])
    assert (found.times, found.median, found.worst, found.kept) == (3, 0.003, 0.004, True)
    line = "wheel falls off                          3    3.0 ms    4.0 ms   50.0 ms  kept"
    assert found.line() == line
    assert len(HEAD) == len(line) - len("  kept")


def test_one_trial_over_the_bound_breaks_it() -> None:
    found = verdict("parts", STRUCK, [Outcome(0.003), Outcome(0.0501)])
    assert found.broken == ["it took 50.1 ms until rest"]
    assert found.line().endswith("BROKEN")


def test_a_trial_that_only_the_machine_made_late_is_void_and_told() -> None:
    found = verdict(
        "parts", STRUCK, [Outcome(0.003), Outcome(0.07, waited=0.03), Outcome(0.004, waited=0.001)]
    )
    assert (found.times, found.void, found.worst, found.kept) == (2, 1, 0.004, True)
    assert found.line().endswith("4.0 ms   50.0 ms  kept, 1 void")
    told = certify("a car", [found], []).summary().splitlines()[1]
    assert (
        told == "void trials: 1, late only because their processes waited for a core (longest wait 30.0 ms)"
    )


def test_waiting_excuses_no_more_than_itself_and_no_motion() -> None:
    assert verdict("parts", STRUCK, [Outcome(0.07, waited=0.01)]).line().endswith("BROKEN")
    assert verdict("parts", STRUCK, [Outcome(0.07, "it moved again", waited=0.03)]).line().endswith("BROKEN")


def test_a_fault_that_was_never_judged_is_not_kept() -> None:
    found = verdict("parts", STRUCK, [Outcome(0.07, waited=0.03)])
    assert not found.kept
    assert found.line().endswith("  0         -         -   50.0 ms  NOT JUDGED, 1 void")


def test_what_broke_is_said_once_however_often_it_did() -> None:
    outcomes = [
        Outcome(None, "its wheels still turned"),
        Outcome(0.001),
        Outcome(None, "its wheels still turned"),
    ]
    found = verdict("parts", STRUCK, outcomes)
    assert found.broken == ["its wheels still turned"]
    assert (found.median, found.times) == (0.001, 3)


def test_a_fault_that_need_not_stop_has_no_times() -> None:
    found = verdict("parts", HARMLESS, [Outcome(None, notes=("it rang",))])
    assert found.line() == "bell rings                               1         -         -         -  kept"
    assert found.notes == ["it rang"]


def test_a_certificate_is_green_only_when_every_fault_is() -> None:
    good = verdict("parts", STRUCK, [Outcome(0.003)])
    bad = verdict("parts", HARMLESS, [Outcome(None, "it did not drive again")])
    assert certify("a car", [good], []).kept
    certificate = certify("a car", [good, bad], ["chip melts"])
    assert not certificate.kept
    said = certificate.summary().splitlines()
    assert said[0] == "1 of 2 faults kept, 2 trials"
    assert said[1] == "left out, for they need a simulated chip: chip melts"
    assert said[2] == "bell rings: it did not drive again"
    assert said[3].startswith("a car, zteleop ")


def test_a_certificate_is_json() -> None:
    certificate = certify("a car", [verdict("parts", STRUCK, [Outcome(0.003)])], [])
    assert msgspec.json.decode(msgspec.json.encode(certificate), type=Certificate) == certificate
