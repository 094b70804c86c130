import pytest
from unit.bus.fakes import Ring, sample

from zteleop.bus import codec, heard
from zteleop.bus.heard import Heard
from zteleop.bus.subscription import Subscription
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.messages import Beat, Refusals, Vehicle
from zteleop.testing import Clock

CAR = to_vehicle(DriveSettings(), 4.08)


@pytest.fixture
def beats() -> Ring:
    return Ring()


@pytest.fixture
def vehicles() -> Ring:
    return Ring()


@pytest.fixture
def refusals() -> Ring:
    return Ring()


@pytest.fixture
def robot(beats: Ring, vehicles: Ring, refusals: Ring, clock: Clock) -> Heard:
    return Heard(
        Subscription(beats, codec.decoders([Beat]), pytest.fail),
        Subscription(vehicles, codec.decoders([Vehicle]), pytest.fail),
        Subscription(refusals, codec.decoders([Refusals]), pytest.fail),
    )


@pytest.fixture
def naps(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Each nap taken; the clock goes on, the test does not wait."""
    naps: list[float] = []
    monkeypatch.setattr(heard.time, "sleep", lambda seconds: (naps.append(seconds), clock.pass_by(seconds)))
    return naps


def test_at_first_nothing_is_known(robot: Heard) -> None:
    robot.listen()
    assert (robot.beat, robot.at, robot.vehicle) == (None, float("-inf"), None)


def test_the_beat_that_arrived_last_counts(robot: Heard, beats: Ring, clock: Clock) -> None:
    beats.samples += [sample(Beat(1, 5.0, 0.0)), sample(Beat(1, 5.05, 0.0))]
    robot.listen()
    assert (robot.beat, robot.at) == (Beat(1, 5.05, 0.0), clock.time)


def test_silence_changes_neither_the_beat_nor_when_it_was_heard(
    robot: Heard, beats: Ring, clock: Clock
) -> None:
    beats.samples.append(sample(Beat(1, 5.0, 0.0)))
    robot.listen()
    clock.pass_by(3.0)
    robot.listen()
    assert (robot.beat, robot.at) == (Beat(1, 5.0, 0.0), clock.time - 3.0)


def test_it_knows_when_it_last_listened_for_a_beat(robot: Heard, clock: Clock) -> None:
    clock.pass_by(3.0)
    robot.listen()
    assert (robot.listened, robot.at) == (clock.time, float("-inf"))


def test_whom_the_robot_refuses_is_heard_without_a_beat(robot: Heard, beats: Ring, refusals: Ring) -> None:
    beats.samples.append(sample(Beat(1, 5.0, 0.0)))
    refusals.samples.append(sample(Refusals([], "", 3)))
    robot.listen_for_refusals()
    assert (robot.refusals, robot.beat) == (Refusals([], "", 3), None)
    robot.listen_for_refusals()
    assert robot.refusals


def test_what_a_robot_says_of_itself_stays_known(robot: Heard, vehicles: Ring) -> None:
    vehicles.samples.append(sample(CAR))
    for _ in range(2):
        robot.listen()
        assert robot.vehicle == CAR


def test_it_waits_until_the_first_beat_and_the_vehicle(
    robot: Heard, beats: Ring, vehicles: Ring, clock: Clock, naps: list[float]
) -> None:
    beats.samples.append(sample(Beat(1, 5.0, 0.0)))
    vehicles.samples.append(sample(CAR))
    assert robot.wait(lambda: pytest.fail("it is there"))
    assert robot.beat == Beat(1, 5.0, 0.0)
    assert naps == []


def test_it_waits_for_a_robot_that_is_not_there_once_and_not_for_ever(
    robot: Heard, clock: Clock, naps: list[float]
) -> None:
    start, told = clock.time, list[float]()
    assert not robot.wait(lambda: told.append(clock.time))
    assert told == [pytest.approx(start + heard.TELL_AFTER, abs=0.01)]
    assert clock.time == pytest.approx(start + heard.HEARD_WITHIN, abs=0.01)
    naps.clear()
    robot.wait(lambda: pytest.fail("once is enough"))
    assert naps == []
