import pytest

from zteleop.cli._draft import Draft, dated
from zteleop.errors import MessageError
from zteleop.messages import PoseStamped, Quaternion, String, Time, Twist, TwistStamped


@pytest.fixture(autouse=True)
def day(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The time of day, which goes on by a second each time it is asked for."""
    told = [100]

    def stamp() -> Time:
        told[0] += 1
        return Time(told[0], 5)

    monkeypatch.setattr("zteleop.bus.clock.stamp", stamp)
    return told


@pytest.mark.parametrize("text", ["{header: auto}", "{header: {stamp: now, frame_id: base}}"])
def test_a_stamp_is_of_the_moment_at_which_it_is_said(text: str) -> None:
    draft = Draft(TwistStamped, text)
    first, second = draft.make(), draft.make()
    assert (first.header.stamp, second.header.stamp) == (Time(101, 5), Time(102, 5))
    assert first.header.frame_id == ("base" if "base" in text else "")


def test_what_is_left_out_is_what_ros_makes_of_it() -> None:
    assert Draft(PoseStamped, "{}").make().pose.orientation == Quaternion(0.0, 0.0, 0.0, 1.0)
    turned = Draft(PoseStamped, "{pose: {orientation: {z: 1.0, w: 0.0}}}").make().pose.orientation
    assert turned == Quaternion(0.0, 0.0, 1.0, 0.0)
    with pytest.raises(MessageError, match=r"pose\.orientation"):
        Draft(PoseStamped, "{pose: {orientation: 3}}")


def test_a_text_in_quotes_is_read_as_what_it_says() -> None:
    assert Draft(Twist, '"linear:\\n  x: 0.5\\n"').make() == Twist.planar(0.5)


def test_what_has_no_such_word_is_made_once() -> None:
    draft = Draft(Twist, "{linear: {x: 0.5}}")
    assert draft.make() == Twist.planar(0.5)
    assert draft.make() is draft.make()
    assert Draft(String, "{data: now}").make() == String("now")


def test_every_stamp_in_a_message_is_meant() -> None:
    values = [{"stamp": "now"}, {"a": {"stamp": "now", "b": 1}}, {"stamp": "later"}]
    assert dated(values, 7) == [{"stamp": 7}, {"a": {"stamp": 7, "b": 1}}, {"stamp": "later"}]


@pytest.mark.parametrize(
    "text", ["{header: now}", "{stamp: now}", "{twist: auto}", "{header: {stamp: auto}}"]
)
def test_what_does_not_fit_is_refused_before_anything_is_said(text: str) -> None:
    with pytest.raises(MessageError):
        Draft(TwistStamped, text)
