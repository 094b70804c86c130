import pytest
from unit.bus.fakes import Clock, Ring, ZenohPublisher, sample

from zteleop.bus import codec
from zteleop.bus.heard import Heard
from zteleop.bus.publisher import Publisher, moves
from zteleop.bus.subscription import Subscription
from zteleop.control.drive import DriveSettings
from zteleop.control.proof import NEVER, Proof, Prover
from zteleop.control.report import describe
from zteleop.errors import MessageError
from zteleop.messages import (
    Beat,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Pwm,
    String,
    Twist,
    TwistStamped,
    Vehicle,
)

CAR = describe(DriveSettings(), 4.08)
FORWARD, REST = Twist.planar(0.5), Twist.planar()


class Operator:
    """A publisher of commands, the beats it hears, and what came out."""

    def __init__(self) -> None:
        self.beats, self.listened, self.zenoh = Ring(), 0, ZenohPublisher()
        beats: Subscription[Beat] = Subscription(self.beats, codec.decoders([Beat]), pytest.fail)
        vehicles: Subscription[Vehicle] = Subscription(Ring(), codec.decoders([Vehicle]), pytest.fail)
        self.heard = Heard(beats, vehicles)
        self.publisher = Publisher(self.zenoh, (Twist, Pwm), Prover(255), self.heard, self.listen)

    def listen(self) -> None:
        self.listened += 1
        self.heard.listen()

    def beat(self, time: float, epoch: int = 1) -> None:
        self.beats.samples.append(sample(Beat(epoch, time)))

    @property
    def proof(self) -> Proof | None:
        attachment = self.zenoh.puts[-1].attachment
        return codec.unpack_proof(attachment) if attachment is not None else None


@pytest.fixture
def operator(clock: Clock) -> Operator:
    return Operator()


def ticks(*data: int) -> Int16MultiArray:
    return Int16MultiArray(MultiArrayLayout.zero(), list(data))


def test_a_message_goes_out_with_its_type_and_no_proof_where_none_is_asked_for() -> None:
    zenoh = ZenohPublisher()
    publisher = Publisher(zenoh, (String,))
    publisher.publish(String("hello"))
    (put,) = zenoh.puts
    assert (put.payload, put.encoding) == (b'{"data":"hello"}', "application/json;std_msgs/msg/String")
    assert put.attachment is None
    assert publisher.sender == ""


def test_each_type_a_topic_takes_goes_out_under_its_own_name(operator: Operator) -> None:
    operator.publisher.publish(FORWARD)
    operator.publisher.publish(Pwm(1, 2))
    assert [put.encoding.rpartition("/")[2] for put in operator.zenoh.puts] == ["Twist", "Pwm"]


@pytest.mark.parametrize("message", [String("x"), TwistStamped(Header.zero(), REST), Twist, None])
def test_another_type_is_refused_by_name(operator: Operator, message: Message) -> None:
    with pytest.raises(MessageError, match=f"expected Twist or Pwm, found {type(message).__name__}"):
        operator.publisher.publish(message)
    assert operator.zenoh.puts == []


def test_what_is_not_finite_is_refused(operator: Operator) -> None:
    with pytest.raises(MessageError, match=r"found nan at Twist.linear.x"):
        operator.publisher.publish(Twist.planar(float("nan")))
    assert operator.zenoh.puts == []


def test_before_the_first_beat_there_is_no_proof(operator: Operator) -> None:
    operator.publisher.publish(FORWARD)
    assert operator.proof is None


def test_publish_is_an_act_with_the_newest_beat(operator: Operator) -> None:
    operator.beat(9.0)
    operator.beat(10.0)
    operator.publisher.publish(FORWARD)
    assert operator.proof == Proof(255, 1, 1, beat=10.0, acted=10.0, began=10.0)


def test_repeat_echoes_a_new_beat_but_no_new_act(operator: Operator, clock: Clock) -> None:
    operator.beat(10.0)
    operator.publisher.publish(FORWARD)
    operator.beat(10.1)
    clock.pass_by(0.1)
    operator.publisher.repeat(FORWARD)
    assert operator.proof == Proof(255, 2, 1, beat=10.1, acted=10.0, began=10.0)
    operator.publisher.act()
    operator.publisher.repeat(FORWARD)
    assert operator.proof == Proof(255, 3, 1, beat=10.1, acted=10.1, began=10.0)


def test_a_repeat_without_an_act_proves_no_act(operator: Operator) -> None:
    operator.beat(10.0)
    operator.publisher.repeat(FORWARD)
    assert operator.proof == Proof(255, 1, 1, beat=10.0, acted=NEVER, began=NEVER)


def test_a_claim_begins_when_it_leaves_neutral(operator: Operator, clock: Clock) -> None:
    for time, command in ((10.0, FORWARD), (10.1, REST), (10.2, FORWARD)):
        operator.beat(time)
        clock.pass_by(0.1)
        operator.publisher.publish(command)
    assert operator.proof.began == 10.2


def test_a_claim_begins_anew_after_silence_on_the_bus_clock(operator: Operator, clock: Clock) -> None:
    for time, wait in ((10.0, 0.0), (10.4, 0.4), (11.0, 0.6)):
        clock.pass_by(wait)
        operator.beat(time)
        operator.publisher.publish(FORWARD)
    assert operator.proof.began == 11.0


def test_a_new_epoch_is_echoed_and_old_acts_are_forgotten(operator: Operator) -> None:
    operator.beat(10.0)
    operator.publisher.publish(FORWARD)
    operator.beat(2.0, epoch=9)
    operator.publisher.repeat(FORWARD)
    assert operator.proof == Proof(255, 2, 9, beat=2.0, acted=NEVER, began=NEVER)


def test_it_listens_before_it_acts_and_before_it_proves(operator: Operator) -> None:
    operator.publisher.act()
    assert operator.listened == 1
    operator.publisher.repeat(REST)
    assert operator.listened == 2


def test_the_sender_is_called_as_the_robot_calls_it(operator: Operator) -> None:
    assert operator.publisher.sender == "ff"


@pytest.mark.parametrize("matching", [True, False])
def test_somebody_hears_when_somebody_subscribes(operator: Operator, matching: bool) -> None:
    operator.zenoh.matching_status.matching = matching
    assert operator.publisher.matched is matching


@pytest.mark.parametrize(
    ("message", "vehicle", "moving"),
    [
        (REST, None, False),
        (Twist.planar(-0.0, -0.0), None, False),
        (Twist.planar(0.1), None, True),
        (Twist.planar(-0.1), None, True),
        (Twist.planar(0.0, -0.1), CAR, True),
        (TwistStamped(Header.zero(), REST), None, False),
        (TwistStamped(Header.zero(), FORWARD), None, True),
        (Pwm(375, 370), CAR, False),
        (Pwm(376, 370), CAR, True),
        (Pwm(375, 371), CAR, True),
        (Pwm(375, 370), None, True),
        (ticks(375, 370), CAR, False),
        (ticks(375, 370, 99), CAR, False),
        (ticks(375, 369), CAR, True),
        (ticks(375, 370), None, True),
        (ticks(), CAR, True),
        (ticks(375), CAR, True),
        (String("stop"), CAR, True),
    ],
    ids=repr,
)
def test_whatever_is_not_surely_neutral_moves(
    message: Message, vehicle: Vehicle | None, moving: bool
) -> None:
    assert moves(message, vehicle) is moving
