from collections.abc import Callable
from typing import ClassVar

import pytest
from unit.bus.fakes import Session

from zteleop.bus import codec, presence
from zteleop.bus.names import Name
from zteleop.bus.session import Reply
from zteleop.bus.types import OwnTypes, ask_type
from zteleop.errors import MessageError
from zteleop.interfaces.schema import fingerprint
from zteleop.messages import GetTypeRequest, GetTypeResponse, Header, Message, String
from zteleop.messages.message import field_types

SOIL = "acme_msgs/msg/Soil"


class Soil(Message):
    """How wet it is."""

    ros_type: ClassVar[str] = SOIL

    header: Header
    moisture: float
    notes: list[str]


@pytest.fixture
def told() -> dict[str, Callable[[GetTypeRequest], GetTypeResponse]]:
    return {}


@pytest.fixture
def types(told: dict[str, Callable[[GetTypeRequest], GetTypeResponse]]) -> OwnTypes:
    def serve(robot: str, tell: Callable[[GetTypeRequest], GetTypeResponse]) -> None:
        assert robot not in told
        told[robot] = tell

    return OwnTypes(serve)


def test_only_who_speaks_a_type_of_its_own_tells_of_it(
    types: OwnTypes, told: dict[str, Callable[[GetTypeRequest], GetTypeResponse]]
) -> None:
    types.add("abe", [String])
    assert told == {}
    types.add("abe", [Soil])
    types.add("abe", [Soil])
    types.add("bob", [Soil])
    assert list(told) == ["abe", "bob"]
    answer = told["abe"](GetTypeRequest(SOIL))
    assert (answer.found, answer.hash) == (True, fingerprint(Soil))
    assert '"x-ros-type":"acme_msgs/msg/Soil"' in answer.schema
    assert told["abe"](GetTypeRequest("std_msgs/msg/String")) == GetTypeResponse(False, "", "")


def here(kind: type[Message] = Soil) -> Session:
    return Session([presence.endpoint_key(Name("abe", "soil"), "pub", "nose", [kind])])


def answers(session: Session, response: GetTypeResponse) -> Session:
    session.reply = Reply(codec.encode(response), codec.encoding_of(GetTypeResponse), refused=False)
    return session


@pytest.mark.parametrize("name", [SOIL, "acme_msgs/Soil", "Soil"])
def test_whoever_never_imported_it_is_told_what_it_is_made_of(
    types: OwnTypes, told: dict[str, Callable[[GetTypeRequest], GetTypeResponse]], name: str
) -> None:
    types.add("abe", [Soil])
    session = answers(here(), told["abe"](GetTypeRequest(SOIL)))
    found = ask_type(session, name)  # type: ignore[arg-type]
    assert found is not None
    assert (found.ros_type, found.__doc__, list(field_types(found))) == (
        SOIL,
        "How wet it is.",
        ["header", "moisture", "notes"],
    )
    assert fingerprint(found) == fingerprint(Soil)
    assert [key for key, *_ in session.asked] == ["robot/abe/srv/nose/get_type"]


def test_a_token_tells_the_hash_of_such_a_type_and_of_no_other() -> None:
    (one,) = presence.endpoints(here())  # type: ignore[arg-type]
    assert (one.type, one.hash) == (SOIL, fingerprint(Soil))
    (one,) = presence.endpoints(here(String))  # type: ignore[arg-type]
    assert (one.type, one.hash) == ("std_msgs/msg/String", "")


def test_where_nobody_speaks_it_or_answers_there_is_none() -> None:
    assert ask_type(here(), "Rain") is None  # type: ignore[arg-type]
    assert ask_type(here(), SOIL) is None  # type: ignore[arg-type]
    assert ask_type(answers(here(), GetTypeResponse(False, "", "")), SOIL) is None  # type: ignore[arg-type]


@pytest.mark.parametrize("schema", ["", "{", "[]", "[" * 10_000, '{"$ref": "#/$defs/Soil", "$defs": {}}'])
def test_a_schema_that_is_none_is_one_sentence(schema: str) -> None:
    with pytest.raises(MessageError):
        ask_type(answers(here(), GetTypeResponse(True, "", schema)), SOIL)  # type: ignore[arg-type]
