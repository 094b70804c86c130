import pytest
from unit.bus.fakes import Outlet, Ring, sample

from zteleop.bus import codec
from zteleop.bus.answer import Answer
from zteleop.bus.heard import Heard
from zteleop.bus.log import NodeLog
from zteleop.bus.publisher import Publisher
from zteleop.bus.subscription import Subscription
from zteleop.control.command import moves
from zteleop.control.mixer import Differential
from zteleop.control.proof import NEVER, Proof, Prover
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.errors import MessageError
from zteleop.messages import (
    Beat,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Pwm,
    Refusals,
    Refused,
    String,
    Twist,
    TwistStamped,
    Vector3,
    Vehicle,
)
from zteleop.testing import Clock

CAR = to_vehicle(DriveSettings(), 4.08)
TANK = to_vehicle(
    DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)
KINDS = "Twist or TwistStamped or Pwm or Int16MultiArray"
FORWARD, REST = Twist.planar(0.5), Twist.planar()


class Operator:
    """A publisher of commands, the beats it hears, and what came out."""

    def __init__(self) -> None:
        self.beats, self.listened, self.outlet = Ring(), 0, Outlet()
        beats: Subscription[Beat] = Subscription(self.beats, codec.decoders([Beat]), pytest.fail)
        self.vehicles, self.refusals = Ring(), Ring()
        vehicles: Subscription[Vehicle] = Subscription(self.vehicles, codec.decoders([Vehicle]), pytest.fail)
        refusals: Subscription[Refusals] = Subscription(
            self.refusals, codec.decoders([Refusals]), pytest.fail
        )
        self.heard = Heard(beats, vehicles, refusals)
        answer = Answer("ff", "cmd_vel", "archangel", self.heard, NodeLog("nose", lambda log: None, print))
        kinds = (Twist, TwistStamped, Pwm, Int16MultiArray)
        self.publisher = Publisher(self.outlet, kinds, Prover(255), self.heard, self.listen, answer)

    def listen(self) -> None:
        self.listened += 1
        self.heard.listen()

    def beat(self, time: float, epoch: int = 1) -> None:
        self.beats.samples.append(sample(Beat(epoch, time, 0.0)))

    @property
    def proof(self) -> Proof | None:
        attachment = self.outlet.puts[-1].attachment
        return codec.unpack_proof(attachment) if attachment is not None else None


@pytest.fixture
def operator(clock: Clock) -> Operator:
    return Operator()


def ticks(*data: int) -> Int16MultiArray:
    return Int16MultiArray(MultiArrayLayout.zero(), list(data))


def test_a_message_goes_out_with_its_type_and_no_proof_where_none_is_asked_for() -> None:
    outlet = Outlet()
    publisher = Publisher(outlet, (String,))
    publisher.publish(String("hello"))
    (put,) = outlet.puts
    assert (put.payload, put.encoding) == (b'{"data":"hello"}', "application/json;std_msgs/msg/String")
    assert put.attachment is None
    assert publisher.sender == ""


def test_each_type_a_topic_takes_goes_out_under_its_own_name(operator: Operator) -> None:
    operator.publisher.publish(FORWARD)
    operator.publisher.publish(Pwm(1, 2))
    assert [put.encoding.rpartition("/")[2] for put in operator.outlet.puts] == ["Twist", "Pwm"]


@pytest.mark.parametrize("message", [String("x"), Beat(1, 2.0, 0.0), Twist, None])
def test_another_type_is_refused_by_name(operator: Operator, message: Message) -> None:
    with pytest.raises(
        MessageError,
        match=f"expected {KINDS}, found {type(message).__name__}",
    ):
        operator.publisher.publish(message)
    assert operator.outlet.puts == []


def test_what_is_not_finite_is_refused(operator: Operator) -> None:
    with pytest.raises(MessageError, match=r"found nan at Twist.linear.x"):
        operator.publisher.publish(Twist.planar(float("nan")))
    assert operator.outlet.puts == []


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


@pytest.mark.parametrize(
    "message",
    [FORWARD, TwistStamped(Header.zero(), FORWARD), Pwm(390, 400), ticks(390, 400)],
    ids=lambda message: type(message).__name__,
)
def test_who_lets_go_says_neutral_of_its_own_type_and_begins_anew(
    operator: Operator, clock: Clock, message: Message
) -> None:
    operator.vehicles.samples.append(sample(CAR))
    for time in (10.0, 10.1):
        clock.pass_by(0.1)
        operator.beat(time)
        operator.publisher.publish(message)
    assert operator.proof.began == 10.0
    operator.publisher.let_go()
    last = operator.outlet.puts[-1]
    said = codec.decode(last.payload, last.encoding, codec.decoders([type(message)]))
    assert type(said) is type(message)
    assert not moves(said, CAR)
    assert operator.proof.acted == 10.1
    operator.beat(10.2)
    operator.publisher.publish(message)
    assert operator.proof.began == 10.2


@pytest.mark.parametrize("vehicle", [None, TANK])
def test_pulses_of_an_unknown_neutral_let_go_in_silence_and_begin_anew(
    operator: Operator, vehicle: Vehicle | None
) -> None:
    """0 ticks are no rest: they are as far back and to the right as the servos go."""
    operator.vehicles.samples += [sample(vehicle)] if vehicle else []
    operator.beat(10.0)
    operator.publisher.publish(Pwm(390, 400))
    operator.publisher.let_go()
    assert len(operator.outlet.puts) == 1
    operator.beat(10.1)
    operator.publisher.publish(Pwm(390, 400))
    assert operator.proof.began == 10.1


def test_neutral_pulses_end_a_claim_although_the_robot_has_not_said_what_neutral_is(
    operator: Operator,
) -> None:
    operator.publisher.publish(Pwm(390, 371))
    operator.beat(10.0)
    operator.publisher.rest(Pwm(375, 370))
    assert operator.proof.began == NEVER
    operator.vehicles.samples.append(sample(CAR))
    operator.beat(10.1)
    operator.publisher.publish(Pwm(390, 371))
    assert operator.proof.began == 10.1


def test_who_commands_nothing_has_nothing_to_let_go() -> None:
    outlet = Outlet()
    publisher = Publisher(outlet, (String,))
    publisher.let_go()
    assert (outlet.puts, publisher.refused) == ([], "")


def test_whoever_publishes_hears_that_it_is_refused(operator: Operator) -> None:
    operator.beat(10.0)
    operator.publisher.publish(FORWARD)
    assert operator.publisher.refused == ""
    operator.refusals.samples.append(sample(Refusals([Refused("ff", "program", "not now", "", 0.6)], "", 0)))
    operator.publisher.publish(FORWARD)
    assert operator.publisher.refused == "not now"


def test_a_program_that_says_one_command_and_ends_is_told_that_nothing_moved(
    operator: Operator, clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    operator.beat(5.0)
    operator.publisher.publish(Twist.planar(1.0, 0.0))
    clock.pass_by(0.004)
    operator.publisher.leave(tell_brief=True)
    said = "what was said on cmd_vel held for 4 ms: a program that ends lets go; publish 10 times a second"
    assert said in capsys.readouterr().out
    operator.publisher.leave(tell_brief=True)
    assert not capsys.readouterr().out, "nothing moves any more"


def test_a_program_that_drove_for_a_while_ends_quietly(
    operator: Operator, clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    operator.beat(5.0)
    for _ in range(3):
        operator.publisher.publish(Twist.planar(1.0, 0.0))
        clock.pass_by(0.05)
    operator.publisher.leave(tell_brief=True)
    assert not capsys.readouterr().out


def test_it_listens_before_it_acts_and_before_it_proves(operator: Operator) -> None:
    operator.publisher.act()
    assert operator.listened == 1
    operator.publisher.repeat(REST)
    assert operator.listened == 2


def test_the_sender_is_called_as_the_robot_calls_it(operator: Operator) -> None:
    assert operator.publisher.sender == "ff"


@pytest.mark.parametrize("matching", [True, False])
def test_somebody_hears_when_somebody_subscribes(operator: Operator, matching: bool) -> None:
    operator.outlet.matched = matching
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


def test_who_asks_for_what_no_wheels_do_is_told(clock: Clock, capsys: pytest.CaptureFixture[str]) -> None:
    operator = Operator()
    operator.publisher.publish(REST)
    assert capsys.readouterr().out == ""
    operator.publisher.publish(Twist(Vector3(0.0, 0.2, 0.0), Vector3.zero()))
    assert "what is said on cmd_vel moves nothing" in capsys.readouterr().out
