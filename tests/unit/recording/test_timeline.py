from typing import Any

import msgspec
import pytest

from zteleop.control.proof import Proof
from zteleop.recording.blackbox_file import Header, Reason, Recorded
from zteleop.recording.timeline import Event, timeline

AT = 100.0
REST = [{"name": "throttle", "fraction": 0.0, "duty_ticks": 370}, {"name": "steering", "duty_ticks": 375}]
MOVED = [{"name": "throttle", "fraction": 0.2, "duty_ticks": 390}, {"name": "steering", "duty_ticks": 375}]


def header(*triggers: tuple[str, str], floods: dict[str, list[tuple[int, int]]] | None = None) -> Header:
    reasons = [Reason(AT, reason, why) for reason, why in triggers] or [Reason(AT, "stop", "so")]
    first = reasons[0]
    return Header(
        1,
        "archangel",
        "1",
        AT,
        "2026-11-21 09:18:20.123",
        first.reason,
        first.why,
        60.0,
        9,
        reasons,
        floods or {},
    )


def line(at: float, path: str, payload: Any, **more: Any) -> Recorded:
    return Recorded(AT + at, f"robot/archangel/{path}", payload=payload, **more)


CAR = line(
    0.0,
    "vehicle",
    {"channels": [{"name": "steering", "neutral_ticks": 375}, {"name": "throttle", "neutral_ticks": 370}]},
)
"""said last: a recording begins with whatever was on its way"""


def pwm(at: float, steering: int, throttle: int, sender: int = 0x13F2A) -> Recorded:
    proof = Proof(sender, 1, 1, 0.0, 0.0, 0.0)
    values = {"steering_ticks": steering, "throttle_ticks": throttle}
    return line(at, "pwm/keyboard", values, proof=proof)


def status(at: float, state: str, why: str, pulses: list[Any] = REST) -> Recorded:
    return line(at, "drive_status", {"state": state, "why": why, "pulses": pulses})


def told(*lines: Recorded, head: Header | None = None) -> list[str]:
    """Return the lines of a timeline that come of messages, with their times."""
    by_time = sorted((*lines, CAR), key=lambda line: line.at)
    events = timeline(head or header(), by_time)
    return [f"{event.at - AT:.2f} {event.text}" for event in events if not event.text.startswith("stop: so")]


def stream(begin: float, end: float, throttle: int = 390) -> list[Recorded]:
    return [pwm(begin + 0.05 * n, 375, throttle) for n in range(round((end - begin) / 0.05) + 1)]


def test_a_drive_has_a_beginning_and_an_end_and_no_line_for_each_repeat() -> None:
    assert told(*stream(-5.0, -2.0), pwm(-1.95, 375, 370), pwm(-1.9, 375, 370)) == [
        "-5.00 keyboard 3f2a begins: steering 375, throttle 390",
        "-1.95 keyboard 3f2a lets go: steering 375, throttle 370",
    ]


def test_changes_are_one_line_as_long_as_they_follow_each_other() -> None:
    lines = [pwm(-5.0 + 0.05 * n, 376 + n, 390) for n in range(20)]
    assert told(*lines, pwm(-4.0, 375, 370), head=header()) == [
        "-5.00 keyboard 3f2a begins: steering 376, throttle 390",
        "-4.95 keyboard 3f2a: steering 395, throttle 390 (the last of 19 in 0.90 s)",
        "-4.00 keyboard 3f2a lets go: steering 375, throttle 370",
    ]


def test_changes_that_go_on_and_on_have_a_line_every_few_seconds() -> None:
    lines = [pwm(-30.0 + 0.05 * n, 376 + n % 2, 390) for n in range(400)]
    assert len(told(*lines, pwm(-9.99, 375, 370))) == 6


def test_a_pause_is_told_when_the_sender_goes_on() -> None:
    lines = [*stream(-5.0, -4.0), *stream(-3.6, -3.0), pwm(-2.95, 375, 370)]
    assert "-3.60 keyboard 3f2a goes on after 0.40 s of silence: steering 375, throttle 390" in told(*lines)


def test_a_pause_that_is_a_senders_way_is_none() -> None:
    lines = [pwm(-20.0 + n, 375, 390) for n in range(10)]
    assert len(told(*lines)) == 3  # it begins, its second word comes late, it falls silent


def test_who_falls_silent_says_its_last_word() -> None:
    assert "-3.00 keyboard 3f2a says its last word (20 a second until then)" in told(*stream(-5.0, -3.0))


def test_who_drives_at_the_end_does_not() -> None:
    assert not [text for text in told(*stream(-5.0, 0.0)) if "last word" in text]


def test_two_senders_are_told_apart() -> None:
    found = told(pwm(-2.0, 375, 390, 0xAAAA), pwm(-2.0, 375, 391, 0xBBBB), pwm(0.0, 375, 370, 0xAAAA))
    assert [text.split()[1:4] for text in found[:2]] == [
        ["keyboard", "aaaa", "begins:"],
        ["keyboard", "bbbb", "begins:"],
    ]


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        ({"data": [380, 390]}, "begins: steering 380, throttle 390"),
        ({"linear": {"x": 0.5}, "angular": {"z": -0.2}}, "begins: +0.50 m/s -0.20 rad/s"),
        ({"twist": {"linear": {"x": 0.5}}}, "begins: +0.50 m/s +0.00 rad/s"),
        ({"data": 5}, "begins: steering None, throttle None"),
        ({"linear": {"x": 10**400}, "angular": 7}, ""),
        ([], ""),
        (None, ""),
    ],
)
def test_any_command_is_put_into_words(payload: Any, words: str) -> None:
    found = told(line(0.0, "cmd_vel/web", payload))
    assert found == ([f"0.00 web without proof {words}"] if words else [])


def test_rest_is_what_the_robot_says_it_is() -> None:
    channels = [{"name": "steering", "neutral_ticks": 300}, {"name": "throttle", "neutral_ticks": 301}]
    vehicle = line(-3.0, "vehicle", {"channels": channels})
    assert told(vehicle, pwm(-2.0, 300, 301)) == []
    assert told(line(-3.0, "vehicle", {"channels": 5}), pwm(-2.0, 375, 370)) == []


def test_a_vehicle_that_nobody_understood_is_told_once() -> None:
    wrong = line(-3.0, "vehicle", None, wrong="not a Vehicle")
    assert told(wrong) == ["-3.00 vehicle: nobody understood a message: not a Vehicle"]


def test_nothing_is_called_rest_where_no_robot_said_what_it_is() -> None:
    (only,) = timeline(header(), [pwm(-2.0, 375, 370)])[:1]
    assert only.text == "keyboard 3f2a begins: steering 375, throttle 370"


def test_a_state_is_told_when_it_begins_and_marked_as_the_reason() -> None:
    why = "keyboard has been silent for 0.3 s"
    lines = [status(-8.0, "driving", "keyboard drives"), status(-7.0, "driving", "keyboard drives, still")]
    lines += [status(0.0, "link lost", why), status(0.05, "link lost", "for longer")]
    events = timeline(header(("link-lost", why)), lines)
    assert [(event.text, event.reason) for event in events] == [
        ("driving: keyboard drives", False),
        (f"link lost: {why}", True),
    ]


def test_another_who_drives_is_told() -> None:
    lines = []
    for at, operator in ((0.0, "1"), (0.1, "1"), (0.2, "2")):
        lines.append(
            line(at, "drive_status", {"state": "driving", "why": f"{operator} drives", "operator": operator})
        )
    assert told(*lines) == ["0.00 driving: 1 drives", "0.20 driving: 2 drives"]


def test_a_limit_that_somebody_changed_is_told() -> None:
    said = "limits.speed is 3.0 now, and was 0.1"
    lines = [
        line(0.0, "log", {"level": 20, "name": "actuator", "msg": text}) for text in (said, "all is well")
    ]
    assert told(*lines) == [f"0.00 actuator says: {said}"]


def test_a_watchdog_that_reads_rest_is_told() -> None:
    words = [
        line(at, "watchdog", {"state": state, "why": "it ended", "moving": moving})
        for at, state, moving in ((0.0, "watching", True), (0.1, "resting", True), (0.15, "resting", False))
    ]
    assert told(*words) == ["0.10 watchdog resting: it ended", "0.15 the watchdog reads pulses of rest"]


def test_rest_that_a_watchdog_has_read_is_not_told_again_by_the_next_actuator() -> None:
    lines = [status(0.0, "driving", "", REST), status(0.1, "driving", "", MOVED)]
    for at, state, moving in ((0.1, "watching", True), (0.2, "resting", False)):
        lines.append(line(at, "watchdog", {"state": state, "why": "it ended", "moving": moving}))
    assert told(*lines, status(0.5, "idle", "", REST))[1:] == [
        "0.10 pulses move: steering 375, throttle 390",
        "0.20 the watchdog reads pulses of rest",
        "0.20 watchdog resting: it ended",
        "0.50 idle: ",
    ]


def test_pulses_are_told_when_they_leave_rest_and_come_back() -> None:
    lines = [status(-3.0, "idle", "", REST), status(-2.0, "idle", "", MOVED), status(-1.0, "idle", "", MOVED)]
    assert told(*lines, status(0.0, "idle", "", REST))[1:] == [
        "-2.00 pulses move: steering 375, throttle 390",
        "0.00 pulses at rest: steering 375, throttle 370",
    ]


def test_pulses_that_differ_by_less_than_a_tick_are_at_rest() -> None:
    least = [{"name": "throttle", "fraction": 0.01, "duty_ticks": 370}, REST[1]]
    lines = [status(-3.0, "idle", "", REST), status(-2.0, "idle", "", least), status(-1.0, "idle", "", MOVED)]
    assert told(*lines, status(-0.5, "idle", "", least), status(0.0, "idle", "", REST))[1:] == [
        "-1.00 pulses move: steering 375, throttle 390",
        "-0.50 pulses at rest: steering 375, throttle 370",
    ]


def test_a_stop_and_its_release_are_told_once_and_by_whom() -> None:
    stop = {"engaged": True, "id": 7, "by": "ann", "why": "a child"}
    lines = [line(0.05 * n, "stop", stop) for n in range(5)]
    lines += [
        line(1.0, "stop", stop | {"engaged": False, "why": ""}),
        line(1.1, "stop", stop | {"id": 8, "by": ""}),
    ]
    events = timeline(header(("stop", "stopped by ann: a child")), lines)
    assert [(event.text, event.reason) for event in events] == [
        ("ann says stop: a child", True),
        ("ann releases the stop", False),
        ("somebody says stop: a child", False),
    ]


def test_a_reason_that_no_message_tells_has_a_line_of_its_own() -> None:
    events = timeline(header(("watchdog-ended", "it said no farewell")), [status(1.0, "idle", "")])
    assert events[0] == Event(AT, "watchdog ended: it said no farewell", reason=True)


def test_only_the_first_reason_is_the_one_it_was_written_for() -> None:
    events = timeline(header(("fault", "a"), ("link-lost", "b")), [])
    assert [(event.text, event.reason) for event in events] == [("fault: a", True), ("link lost: b", False)]


def test_two_reasons_that_are_one_event_are_what_it_was_written_for() -> None:
    stop = line(0.0, "stop", {"engaged": True, "id": 7, "by": "ann", "why": ""})
    events = timeline(header(("stop", "stopped by ann"), ("stop", "stopped by bert")), [stop])
    assert [(event.text, event.reason) for event in events] == [("ann says stop", True)]


def test_a_watchdog_is_told_when_it_changes() -> None:
    def dog(at: float, state: str, restarts: int, why: str) -> Recorded:
        return line(at, "watchdog", {"state": state, "restarts": restarts, "why": why})

    gone = "the actuator is gone: it ended"
    found = told(dog(-2, "watching", 0, "steps"), dog(0, "resting", 0, gone), dog(1, "starting", 1, gone))
    assert found == [
        f"0.00 watchdog resting: {gone}",
        f"1.00 watchdog starting, another actuator is started: {gone}",
    ]


def test_logs_are_told_from_warnings_on() -> None:
    lines = [line(-2.0, "log", {"level": level, "name": "chip", "msg": "hot"}) for level in (10, 20, 30, 40)]
    assert told(*lines) == ["-2.00 chip warns: hot", "-2.00 chip reports an error: hot"]


def test_a_new_epoch_and_a_gap_between_beats_are_told() -> None:
    beats = [(-3.0, 1), (-2.9, 1), (-2.0, 1), (-1.9, 2)]
    found = told(*[line(at, "beat", {"epoch": epoch, "time": 0.0}) for at, epoch in beats])
    assert found == [
        "-2.00 the first beat of the actuator for 0.90 s",
        "-1.90 the actuator begins anew: who drove must let go first",
    ]


def test_what_nobody_understood_is_one_line() -> None:
    lines = [line(-2.0 + 0.01 * n, "pwm/keyboard", msgspec.UNSET, wrong="not a Pwm") for n in range(50)]
    assert told(*lines) == [
        "-2.00 pwm/keyboard: nobody understood a message: not a Pwm (the last of 50 in 0.49 s)"
    ]


@pytest.mark.parametrize("path", ["drive_status", "stop", "watchdog", "log", "beat"])
@pytest.mark.parametrize("payload", [None, 5, [], msgspec.UNSET, {"state": 5, "engaged": 5, "level": "x"}])
def test_a_message_of_another_version_ends_nothing(path: str, payload: Any) -> None:
    found = told(line(-2.0, path, payload))
    assert len(found) == 1
    assert f"{path}: this version cannot read a message" in found[0]


def test_floods_are_told_with_their_number() -> None:
    floods = {"junk": [(97, 900), (98, 20_000)], "empty": []}
    assert told(head=header(floods=floods)) == [
        "-3.00 a flood on junk: up to 20000 messages a second, for 2 s"
    ]


def test_topics_without_room_are_told() -> None:
    found = told(head=msgspec.structs.replace(header(), elsewhere=7))
    assert found == ["0.00 7 messages on more topics than there is room for"]
