import json
import struct

import pytest
from unit.bus.fakes import put, sample

from zteleop.bridges.web.watching import LARGEST, framed
from zteleop.bus.names import Name
from zteleop.messages import CompressedImage, Header, Time

ODOM = Name("archangel", "odom")
KEY = "robot/archangel/odom"


def test_json_passes_as_it_is_with_its_type() -> None:
    frame = framed("odom", ODOM, put(b'{"x": 1.50}', "application/json;a/b", KEY))
    assert isinstance(frame, str)
    assert '"message":{"x": 1.50}' in frame
    assert json.loads(frame)["type"] == "a/b"


def test_of_a_command_each_source_is_told_apart() -> None:
    name = Name("archangel", "cmd_vel")
    frame = framed("cmd_vel", name, put(b"1", "application/json;a/b", "robot/archangel/cmd_vel/web"))
    assert json.loads(str(frame))["topic"] == "cmd_vel/web"


@pytest.mark.parametrize(
    ("payload", "encoding"),
    [
        (b'{"x":', "application/json;a/b"),
        (b"\xff", "application/json;a/b"),
        (b"[" * 100_000, "application/json;a/b"),
        (b" " * (LARGEST + 1), "application/json;a/b"),
        (b"1", "application/octet-stream"),
        (b"1", ""),
        (b"{}", "application/json;sensor_msgs/msg/CompressedImage"),
    ],
    ids=["cut", "no text", "deep", "large", "bytes", "nothing", "no picture"],
)
def test_what_a_page_could_not_read_is_left_out(payload: bytes, encoding: str) -> None:
    assert framed("odom", ODOM, put(payload, encoding, KEY)) is None


def test_a_delete_is_no_message() -> None:
    assert framed("odom", ODOM, put(b"1", "application/json;a/b", KEY, is_put=False)) is None


def test_a_picture_is_its_time_and_its_bytes() -> None:
    image = CompressedImage(Header(Time(12, 500_000_000), "camera"), "jpeg", b"\xff\xd8")
    assert framed("camera", ODOM, sample(image, KEY)) == struct.pack(">d", 12.5) + b"\xff\xd8"
