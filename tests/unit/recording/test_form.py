import msgspec
import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import cdr
from zteleop.interfaces.form import Form, form_of, json_form_of, writer_of
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Pwm, String, TwistStamped
from zteleop.recording.form import reader_of, type_of, unknown, values_of

TWIST = TwistStamped.zero()
OWN = Form(
    "garden_msgs/msg/Soil",
    "cdr",
    "ros2msg",
    b"float32 wet\nstring bed\nPot pot\n" + b"=" * 80 + b"\nMSG: garden_msgs/Pot\nint16 size\n",
)


@pytest.mark.parametrize("message", [TWIST, String("hello"), Pwm(300, 370)])
def test_what_is_written_in_a_form_is_read_in_it(message: TwistStamped | String | Pwm) -> None:
    form = form_of(type(message))
    assert type_of(form) is type(message)
    assert reader_of(form)(writer_of(type(message))(message)) == message
    assert values_of(form)(cdr.encode(message)) == msgspec.to_builtins(message)


def test_a_type_that_only_the_file_knows_is_read() -> None:
    data = b"\0\1\0\0\0\0\xc0\x3f\2\0\0\0a\0\7\0"
    assert values_of(OWN)(data) == {"wet": 1.5, "bed": "a", "pot": {"size": 7}}
    assert type_of(OWN) is type_of(Form(*OWN))


def test_a_type_that_the_file_describes_otherwise_is_the_files() -> None:
    form = Form("std_msgs/msg/String", "cdr", "ros2msg", b"int32 data\n")
    assert values_of(form)(b"\0\1\0\0\7\0\0\0") == {"data": 7}
    assert type_of(form) is not String


@pytest.mark.parametrize("schema_encoding", ["", "ros2idl", "omgidl"])
def test_without_a_schema_a_type_of_ros_is_what_its_name_says(schema_encoding: str) -> None:
    form = Form("sensor_msgs/msg/Joy", "cdr", schema_encoding, b"module ...")
    assert type_of(form) is struct_of("sensor_msgs/msg/Joy")
    assert type_of(Form("std_msgs/msg/String", "cdr")) is String


def test_json_is_read_by_its_schema() -> None:
    form = json_form_of(TwistStamped)
    assert (form.encoding, form.schema_encoding) == ("json", "jsonschema")
    data = msgspec.json.encode(TWIST)
    assert msgspec.to_builtins(reader_of(form)(data)) == values_of(form)(data) == msgspec.to_builtins(TWIST)


@pytest.mark.parametrize("schema", [b"", b"{", b"3", b'{"type": "object"}'])
def test_json_whose_schema_is_none_is_read_all_the_same(schema: bytes) -> None:
    form = Form("x", "json", "jsonschema", schema)
    assert values_of(form)(b'{"a": [1, null]}') == {"a": [1, None]}
    with pytest.raises(MessageError):
        reader_of(form)
    with pytest.raises(MessageError, match="not JSON"):
        values_of(form)(b"{")


def test_what_came_in_an_unknown_way_is_kept_as_it_came() -> None:
    assert unknown("application/json;x/msg/Y") == Form("x/msg/Y", "json")
    assert unknown("application/msgpack;x/msg/Y") == Form("x/msg/Y", "msgpack")
    assert values_of(unknown("application/msgpack;x"))(msgspec.msgpack.encode({"a": b"b"})) == {"a": b"b"}
    with pytest.raises(MessageError, match="not MessagePack"):
        values_of(unknown("application/msgpack;x"))(b"\xc1")


@pytest.mark.parametrize(
    "form",
    [
        Form("x/msg/Y", "cdr"),
        Form("x/msg/Y", "ros1", "ros1msg", b"int32 x"),
        Form("x/msg/Y", "protobuf", "protobuf", b"\0"),
        Form("x/msg/Y", "cdr", "ros2msg", b"int32"),
        Form("x/msg/Y", "cdr", "ros2msg", b"Other x"),
        Form("x/msg/Y", "cdr", "ros2msg", b"\xff\xfe"),
        Form("x/msg/Y", "cdr", "ros2msg", b"Y y"),
        Form("", "", "", b""),
        Form("x" * 10**6, "y" * 10**6, "z" * 10**6, b""),
    ],
)
def test_what_nobody_here_can_read_is_said_in_a_sentence(form: Form) -> None:
    with pytest.raises(MessageError) as refusal:
        values_of(form)
    assert len(str(refusal.value)) < 400
    with pytest.raises(MessageError):
        reader_of(form)


@pytest.mark.parametrize("data", [b"", b"\0", b"\0\1\0\0", b"\0\1\0\0" + b"\xff" * 100, b"\xff" * 100])
def test_bytes_that_are_no_message_are_refused(data: bytes) -> None:
    for form in (OWN, form_of(TwistStamped), json_form_of(TwistStamped)):
        with pytest.raises(MessageError):
            reader_of(form)(data)
