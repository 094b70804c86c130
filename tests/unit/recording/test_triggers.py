import pytest

from zteleop.bus import codec
from zteleop.bus.tap import Raw
from zteleop.messages import DriveStatus, Message, Stop, WatchdogStatus
from zteleop.recording.triggers import Trigger, Triggers


def raw(path: str, message: Message, at: float = 5.0) -> Raw:
    return Raw(at, path, codec.encoding_of(type(message)), codec.encode(message), b"", False)


def status(state: str, why: str = "so", stop: int = 0, at: float = 5.0) -> Raw:
    message = DriveStatus.zero()
    message.state, message.why = state, why  # type: ignore[assignment]
    if stop or state == "stopped":
        message.stops = [Stop(engaged=True, id=stop, by="ann", why="")]
    return raw("drive_status", message, at)


def dog(state: str, restarts: int, why: str = "the actuator is gone: it ended") -> Raw:
    message = WatchdogStatus.zero()
    message.state, message.restarts, message.why = state, restarts, why  # type: ignore[assignment]
    return raw("watchdog", message)


def stop(number: int, engaged: bool = True, why: str = "") -> Raw:
    return raw("stop", Stop(engaged=engaged, id=number, by="ann", why=why))


def reasons(*said: Raw) -> list[str | None]:
    triggers = Triggers()
    found = [triggers.hear(message) for message in said]
    return [trigger.reason if trigger else None for trigger in found]


@pytest.mark.parametrize(
    ("state", "reason"),
    [("link lost", "link-lost"), ("operator idle", "operator-idle"), ("fault", "fault"), ("idle", None)],
)
def test_a_state_is_a_reason_when_it_begins(state: str, reason: str | None) -> None:
    assert reasons(status("driving"), status(state), status(state)) == [None, reason, None]


def test_a_state_that_comes_and_goes_is_a_reason_once_a_minute() -> None:
    """As it does where a program publishes once a second, and is obeyed for half of it."""
    said = [status("driving" if half % 2 == 0 else "link lost", at=half / 2) for half in range(250)]
    found = [trigger for trigger in map(Triggers().hear, said) if trigger]
    assert [trigger.at for trigger in found] == [0.5, 60.5, 120.5], "each file holds what is between"


def test_a_state_that_comes_back_later_is_a_reason_again() -> None:
    triggers = Triggers()
    said = [("driving", 1.0), ("link lost", 2.0), ("driving", 3.0), ("link lost", 7.5), ("idle", 8.0)]
    found = [trigger.at for state, at in said if (trigger := triggers.hear(status(state, at=at)))]
    assert found == [2.0, 7.5]


def test_a_reason_has_the_moment_and_the_sentence_of_its_message() -> None:
    triggers = Triggers()
    triggers.hear(status("driving"))
    found = triggers.hear(status("fault", "the chip does not answer"))
    assert found == Trigger(5.0, "fault", "the chip does not answer")


def test_what_is_so_from_the_beginning_is_no_reason() -> None:
    assert reasons(status("fault")) == [None]
    assert reasons(status("stopped", stop=7), status("stopped", stop=7)) == [None, None]
    assert reasons(dog("watching", 3), dog("watching", 3)) == [None, None]


def test_a_stop_is_a_reason_once_however_often_it_is_said_and_shown() -> None:
    said = (status("driving"), stop(7), stop(7), status("stopped", stop=7), stop(7))
    assert reasons(*said) == [None, "stop", None, None, None]


def test_a_stop_that_only_the_status_shows_is_a_reason() -> None:
    assert reasons(status("idle"), status("stopped", stop=7), stop(7)) == [None, "stop", None]


def test_a_stop_without_a_number_is_a_reason() -> None:
    assert reasons(status("idle"), status("stopped"), status("stopped")) == [None, "stop", None]


def test_a_stop_without_a_number_is_one_reason_however_often_it_is_said() -> None:
    said = (status("idle"), stop(0), stop(0), status("stopped"), stop(0), status("idle"), status("stopped"))
    assert reasons(*said) == [None, None, None, "stop", None, None, "stop"]


def test_a_stop_in_force_is_none_when_it_is_said_again() -> None:
    assert reasons(status("stopped", stop=7), stop(7)) == [None, None]


def test_two_stops_said_in_turns_are_two_reasons() -> None:
    assert reasons(stop(7), stop(8), stop(7), stop(8)) == ["stop", "stop", None, None]


def test_another_stop_of_a_robot_that_stands_stopped_is_no_reason() -> None:
    assert reasons(status("idle"), status("stopped", stop=7), stop(8)) == [None, "stop", None]
    assert reasons(status("idle"), status("stopped", stop=7), status("stopped", stop=8)) == [
        None,
        "stop",
        None,
    ]
    again = (status("stopped", stop=7), stop(8), status("stopped", stop=8), status("idle"), stop(9))
    assert reasons(*again) == [None, None, None, None, "stop"]


def test_a_stop_says_who_and_why() -> None:
    found = Triggers().hear(stop(7, why="a child"))
    assert found
    assert found.why == "stopped by ann: a child"


def test_a_release_is_no_reason_and_the_next_stop_is() -> None:
    said = (stop(7), status("stopped", stop=7), stop(7, engaged=False), status("idle"), stop(8))
    assert reasons(*said) == ["stop", None, None, None, "stop"]


def test_an_actuator_that_ends_is_a_reason_once() -> None:
    said = (dog("watching", 0), dog("resting", 0), dog("resting", 0), dog("starting", 1), dog("watching", 1))
    assert reasons(*said) == [None, "actuator-ended", None, None, None]


def test_a_restart_is_seen_even_where_its_rest_was_not() -> None:
    assert reasons(dog("watching", 0), dog("starting", 1)) == [None, "actuator-ended"]


@pytest.mark.parametrize(
    "said",
    [
        Raw(0.0, "drive_status", "application/json;zteleop_msgs/msg/DriveStatus", b"{", b"", False),
        Raw(0.0, "stop", "text/plain", b"stop", b"", False),
        stop(7)._replace(path="lidar"),
        stop(7)._replace(deleted=True),
        stop(7)._replace(path="robot/*/stop"),
    ],
)
def test_what_is_no_message_is_no_reason(said: Raw) -> None:
    assert reasons(said) == [None]
