import json

import msgspec
import pytest

from zteleop.messages import Int16MultiArray, MultiArrayLayout, Twist
from zteleop.text.form import Form, before
from zteleop.text.rendering import Style

TYPE = Twist.ros_type
TWIST = msgspec.to_builtins(Twist.planar(0.5, 1.0))
WHOLE = [("", TWIST)]
FIELDS = [("linear.x", 0.5), ("angular", TWIST["angular"])]
INFO = {
    "source_timestamp": None,
    "received_timestamp": 12,
    "publication_sequence_number": 3,
    "reception_sequence_number": 1,
    "key": "robot/abe/cmd_vel/program",
}


def test_yaml_is_a_document_a_message() -> None:
    text = Form().text(WHOLE, TYPE)
    assert text.startswith("linear:\n  x: 0.5\n")
    assert text.endswith("\n---")
    assert Form().text([("linear.x", 0.5)], TYPE) == "0.5\n---"
    assert Form().text(FIELDS, TYPE) == "linear.x: 0.5\nangular:\n  x: 0.0\n  y: 0.0\n  z: 1.0\n---"


def test_what_is_known_about_a_message_comes_before_it() -> None:
    text = Form().text([("linear.x", 0.5)], TYPE, INFO)
    assert text.startswith("source_timestamp: null\nreceived_timestamp: 12\npublication_sequence_number: 3\n")
    assert text.endswith("key: robot/abe/cmd_vel/program\n---\n0.5\n---")
    assert before(None) == ""


def test_json_is_a_line_a_message() -> None:
    assert json.loads(Form("json").text(WHOLE, TYPE)) == TWIST
    assert Form("json").text([("linear.x", 0.5)], TYPE) == "0.5"
    assert json.loads(Form("json").text(FIELDS, TYPE)) == dict(FIELDS)
    assert json.loads(Form("json").text(WHOLE, TYPE, INFO)) == {"info": INFO, "message": TWIST}


def test_csv_is_a_row_a_message() -> None:
    assert Form("csv").text(WHOLE, TYPE) == "0.5,0.0,0.0,0.0,0.0,1.0"
    assert Form("csv").text(WHOLE, TYPE, INFO) == ",12,3,1,0.5,0.0,0.0,0.0,0.0,1.0"
    assert Form("csv").text([("", 5)], TYPE) == "5"


def test_a_header_names_the_columns_and_is_said_again_when_they_change() -> None:
    form = Form("csv", header=True)
    assert form.text(FIELDS, TYPE, INFO) == (
        "source_timestamp,received_timestamp,publication_sequence_number,reception_sequence_number,"
        "linear.x,angular.x,angular.y,angular.z\n,12,3,1,0.5,0.0,0.0,1.0"
    )
    assert form.text(FIELDS, TYPE, INFO) == ",12,3,1,0.5,0.0,0.0,1.0"
    assert form.text([("data", [1, 2])], "") == "data[0],data[1]\n1,2"
    assert form.text([("", 5)], "") == "data\n5"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("yaml", "data: '<sequence type: int16, length: 1>'\n---"),
        ("csv", '"<sequence type: int16, length: 1>"'),
        ("json", '{"data":"<sequence type: int16, length: 1>"}'),
    ],
)
def test_every_form_obeys_the_style(name: str, text: str) -> None:
    values = msgspec.to_builtins(Int16MultiArray(MultiArrayLayout([], 0), [1]))
    del values["layout"]
    form = Form(name, Style(no_arrays=True))  # type: ignore[arg-type]
    assert form.text([("", values)], Int16MultiArray.ros_type) == text
