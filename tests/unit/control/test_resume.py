import pytest

from zteleop.control.gate import Refusal
from zteleop.control.resume import AT_MOST_EVERY, NOT_BEGUN, Resume
from zteleop.messages import DriveStatus, Refusals, Refused, Stop

BEGAN_EARLIER = Refusal.NOT_FROM_NEUTRAL


def status(released: int = 0, stop: int = 0, operator: str = "", state: str = "idle") -> DriveStatus:
    status = DriveStatus.zero()
    status.released, status.operator, status.state = released, operator, state
    if stop or state == "stopped":
        status.stops = [Stop(True, stop, "ann", "")]
    return status


def refused(why: str = BEGAN_EARLIER, sender: str = "ff", rest: str = "", released: int = 0) -> Refusals:
    return Refusals([Refused(sender, "program", why, "", 0.6)], rest, released)


@pytest.fixture
def resume() -> Resume:
    resume = Resume("ff")
    resume.heed(status(operator="ff", state="driving"))
    return resume


@pytest.mark.parametrize("why", [Refusal.EARLIER_START, Refusal.NOT_FROM_NEUTRAL, Refusal.BEFORE_REPAIR])
def test_after_a_restart_it_may(resume: Resume, why: str) -> None:
    assert resume.may(refused(why), 10.0)


@pytest.mark.parametrize("why", [why for why in Refusal if why not in NOT_BEGUN] + ["something new"])
def test_for_any_other_reason_it_may_not(resume: Resume, why: str) -> None:
    assert not resume.may(refused(why), 10.0)


def test_while_it_is_obeyed_or_another_is_refused_it_may_not(resume: Resume) -> None:
    assert not resume.may(None, 10.0)
    assert not resume.may(Refusals([], "", 0), 10.0)
    assert not resume.may(refused(sender="ee"), 10.0)


def test_while_the_robot_is_kept_at_rest_it_may_not(resume: Resume) -> None:
    assert not resume.may(refused(rest="stopped by ann"), 10.0)


@pytest.mark.parametrize("seen", [status(stop=5, state="stopped"), status(state="stopped"), status(5)])
def test_a_stop_that_was_seen_needs_a_person_also_when_it_is_over(resume: Resume, seen: DriveStatus) -> None:
    resume.heed(seen)
    resume.heed(status())
    assert not resume.may(refused(), 10.0)


def test_a_stop_that_was_not_seen_needs_a_person_as_well(resume: Resume) -> None:
    assert not resume.may(refused(released=5), 10.0)


def test_once_a_person_let_it_drive_after_a_stop_it_may_again(resume: Resume) -> None:
    resume.heed(status(stop=5, state="stopped"))
    resume.heed(status(released=5))
    resume.heed(status(released=5, operator="ee", state="driving"))
    assert not resume.may(refused(released=5), 10.0)
    resume.heed(status(released=5, operator="ff", state="driving"))
    assert resume.may(refused(released=5), 20.0)


def test_who_has_heard_nothing_of_the_robot_may_not() -> None:
    assert not Resume("ff").may(refused(), 10.0)


def test_who_was_never_seen_to_be_obeyed_may_not() -> None:
    """It may have been, and a stop have come and gone since, before the first word that it heard."""
    resume = Resume("ff")
    resume.heed(status(released=5))
    assert not resume.may(refused(released=5), 10.0)


def test_who_began_under_a_stop_may_not_when_it_is_released() -> None:
    resume = Resume("ff")
    resume.heed(status(stop=5, state="stopped"))
    resume.heed(status(released=5))
    assert not resume.may(refused(released=5), 10.0)


def test_each_word_of_the_robot_is_answered_once_and_not_in_haste(resume: Resume) -> None:
    told = refused()
    assert resume.may(told, 10.0)
    assert not resume.may(told, 20.0)
    assert resume.may(refused(), 20.0)
    assert not resume.may(refused(), 20.0 + AT_MOST_EVERY)
    assert resume.may(refused(), 20.1 + AT_MOST_EVERY)
