from collections.abc import Callable

import pytest
from unit.bus.fakes import Session

from zteleop.bus import codec, presence, service
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.bus.service import BUSY, WAITING, Services, call
from zteleop.bus.session import Question, Reply
from zteleop.errors import BusError, ConfigError, MessageError
from zteleop.messages import (
    Message,
    SetBoolRequest,
    SetBoolResponse,
    String,
    TriggerRequest,
    TriggerResponse,
    Twist,
)

LIGHTS = Name("archangel", "lights")
KEY = "robot/archangel/srv/lights"
YES = SetBoolResponse(True, "on")


class Desk:
    """Services of one node, and whoever asks them."""

    def __init__(self) -> None:
        self.session, self.loop = Session(), Loop(lambda: None)
        self.complaints: list[str] = []
        self.answers: list[tuple[bytes, str]] = []
        self.refusals: list[str] = []
        self.services = Services(self.session, "nose", self.loop, self.complaints.append)  # type: ignore[arg-type]

    def add(self, handler: Callable[[SetBoolRequest], SetBoolResponse]) -> None:
        self.services.add(LIGHTS, SetBoolRequest, SetBoolResponse, handler)

    def ask(self, payload: bytes, encoding: str = "application/json;std_srvs/srv/SetBool_Request") -> None:
        question = Question(payload, encoding, lambda *said: self.answers.append(said), self.refusals.append)
        self.session.served[KEY](question)

    def spin(self) -> None:
        self.loop.run(0.0)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_a_question_is_answered_in_the_loop_and_not_before(desk: Desk) -> None:
    heard = []
    desk.add(lambda asked: heard.append(asked) or YES)  # type: ignore[func-returns-value]
    desk.ask(b'{"data": true}')
    assert desk.answers == []
    desk.spin()
    assert heard == [SetBoolRequest(True)]
    assert desk.answers == [(codec.encode(YES), "application/json;std_srvs/srv/SetBool_Response")]


def test_what_never_changes_is_answered_whatever_the_node_does(desk: Desk) -> None:
    desk.services.add(LIGHTS, SetBoolRequest, SetBoolResponse, lambda asked: YES, at_once=True)
    desk.ask(b'{"data": true}')
    assert desk.answers == [(codec.encode(YES), "application/json;std_srvs/srv/SetBool_Response")]
    desk.ask(b'{"data": 7}')
    assert len(desk.refusals) == 1


def test_others_are_told_which_service_there_is_and_of_which_type(desk: Desk) -> None:
    desk.add(lambda asked: YES)
    desk.services.add(
        Name("archangel", "quiet"), SetBoolRequest, SetBoolResponse, lambda asked: YES, stands=False
    )
    (there,) = presence.services(desk.session)  # type: ignore[arg-type]
    assert (there.robot, there.node, there.topic, there.type) == (
        "archangel",
        "nose",
        "lights",
        "std_srvs/srv/SetBool",
    )


@pytest.mark.parametrize(
    ("payload", "encoding", "words"),
    [
        (b"{}", "application/json;std_srvs/srv/SetBool_Request", "not a std_srvs/srv/SetBool_Request"),
        (b"{}", "application/json;std_srvs/srv/Trigger_Request", "expected std_srvs/srv/SetBool_Request"),
        (b"\xff", "", "expected std_srvs/srv/SetBool_Request"),
    ],
)
def test_what_is_no_such_question_is_refused_in_words(
    desk: Desk, payload: bytes, encoding: str, words: str
) -> None:
    desk.add(pytest.fail)
    desk.ask(payload, encoding)
    desk.spin()
    assert [words in refusal for refusal in desk.refusals] == [True]
    assert desk.complaints == []


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (
            TriggerResponse(True, ""),
            "TypeError: expected a SetBoolResponse of its handler, found TriggerResponse(",
        ),
        (None, "TypeError: expected a SetBoolResponse of its handler, found None"),
    ],
)
def test_a_handler_that_answers_with_something_else_is_told_of(
    desk: Desk, answer: Message | None, words: str
) -> None:
    desk.add(lambda asked: answer)  # type: ignore[arg-type,return-value]
    desk.ask(b'{"data": true}')
    desk.spin()
    assert desk.refusals[0].startswith(f"its handler failed: {words}")
    assert desk.complaints[0].startswith(f"/archangel/lights: its handler failed: {words}")


def test_a_handler_that_raises_ends_nothing(desk: Desk) -> None:
    def fails(asked: SetBoolRequest) -> SetBoolResponse:
        if asked.data:
            raise ZeroDivisionError("by a cat")
        return YES

    desk.add(fails)
    desk.ask(b'{"data": true}')
    desk.ask(b'{"data": false}')
    desk.spin()
    assert desk.refusals == ["its handler failed: ZeroDivisionError: by a cat"]
    assert len(desk.answers) == 1


def test_a_flood_of_questions_is_refused_and_those_that_wait_are_answered(desk: Desk) -> None:
    desk.add(lambda asked: YES)
    for _ in range(WAITING + 5):
        desk.ask(b'{"data": true}')
    assert desk.refusals == [BUSY] * 5
    desk.spin()
    assert len(desk.answers) == WAITING
    desk.ask(b'{"data": true}')
    desk.spin()
    assert (len(desk.answers), len(desk.refusals)) == (WAITING + 1, 5)


@pytest.mark.parametrize(
    ("request_type", "response_type"),
    [(SetBoolRequest, TriggerResponse), (Twist, SetBoolResponse), (SetBoolResponse, SetBoolRequest)],
)
def test_two_messages_that_are_of_no_service_are_refused(
    desk: Desk, request_type: type[Message], response_type: type[Message]
) -> None:
    with pytest.raises(ConfigError, match="expected the request and the response of one service"):
        desk.services.add(LIGHTS, request_type, response_type, pytest.fail)
    assert desk.session.served == {}


def ask(session: Session, request: Message | None = None) -> SetBoolResponse:
    return call(session, LIGHTS, request or SetBoolRequest(True), SetBoolResponse, 0.5)  # type: ignore[arg-type]


def test_whoever_asks_gets_the_answer() -> None:
    session = Session()
    session.reply = Reply(codec.encode(YES), codec.encoding_of(SetBoolResponse), refused=False)
    assert ask(session) == YES
    assert session.asked == [(KEY, b'{"data":true}', "application/json;std_srvs/srv/SetBool_Request", 0.5)]


def test_a_refusal_is_an_error_in_its_own_words() -> None:
    session = Session()
    session.reply = Reply(b"no such \xff lamp", "text/plain", refused=True)
    with pytest.raises(BusError, match=r"^/archangel/lights refuses: no such \ufffd lamp$"):
        ask(session)


def test_an_answer_of_another_type_is_an_error() -> None:
    session = Session()
    session.reply = Reply(codec.encode(String("on")), codec.encoding_of(String), refused=False)
    with pytest.raises(
        MessageError, match=r"expected std_srvs/srv/SetBool_Response, found 'std_msgs/msg/String'"
    ):
        ask(session)


def test_whoever_asks_with_another_type_is_told_before_anybody_is_asked() -> None:
    session = Session()
    with pytest.raises(ConfigError, match="of one service"):
        ask(session, TriggerRequest())
    assert session.asked == []


@pytest.mark.parametrize(
    ("serves", "words"),
    [
        (
            "lights",
            r"nose on [\w-]+ did not answer /archangel/lights within 0.5 s: it is busy, or does not spin$",
        ),
        ("light", r"nobody serves /archangel/lights; did you mean /archangel/light\?$"),
        ("", "nobody serves /archangel/lights here$"),
    ],
)
def test_silence_is_told_with_who_should_have_answered(serves: str, words: str) -> None:
    there = presence.service_key(Name("archangel", serves), "nose", "std_srvs/srv/SetBool")
    session = Session([there] if serves else [])
    with pytest.raises(BusError, match=f"^{words}"):
        ask(session)


@pytest.mark.parametrize(("mine", "words"), [(True, " here"), (False, r"; did you mean /michael/lights\?")])
def test_another_robots_service_is_not_meant_where_ones_own_is_there(mine: bool, words: str) -> None:
    tokens = [presence.service_key(Name("michael", "lights"), "nose", "std_srvs/srv/SetBool")]
    session = Session([*tokens, *([presence.node_key("archangel", "actuator")] if mine else [])])
    with pytest.raises(BusError, match=f"^nobody serves /archangel/lights{words}$"):
        ask(session)


def test_a_node_that_is_busy_is_not_said_to_serve_nothing() -> None:
    session = Session([presence.node_key("archangel", "nose")])
    with pytest.raises(BusError, match=r"^nose on [\w-]+ did not answer /archangel/nose/lights within"):
        call(session, Name("archangel", "nose/lights"), SetBoolRequest(True), SetBoolResponse, 0.5)  # type: ignore[arg-type]


def test_the_type_of_a_service_is_what_its_halves_share() -> None:
    assert service.service_type_of(TriggerRequest, TriggerResponse) == "std_srvs/srv/Trigger"
