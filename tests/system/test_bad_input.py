"""Whatever strangers say on any topic: never motion, never a dead process, and few words about it."""

import json
import struct
import time
from collections.abc import Callable, Iterator
from itertools import cycle, product
from typing import Any

import msgspec
import pytest
import zenoh
from hypothesis import given, settings
from hypothesis import strategies as st
from rig import NEUTRAL, Process, Rig, Terminal, Watch, hear, repeating, until

from zteleop.bus import codec
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.messages import (
    MESSAGES,
    Beat,
    DriveStatus,
    Int16MultiArray,
    Log,
    Message,
    Odometry,
    Pwm,
    Twist,
    TwistStamped,
    Vehicle,
)

BLOCK = zenoh.CongestionControl.BLOCK
LINES_A_SECOND = 10
LEFT = "\x1b[D"
OUTPUT = "Currently outputting:[Steering PWM, Throttle PWM] = "
GOOD = ((Twist.planar(0.0, 0.05), (401, 370)), (Pwm(381, 370), (381, 370)))
"""Commands of the steering alone, to places where nothing bad sends it."""
PRESSED = {"a": (390, 370), "d": (360, 370), "w": (375, 374), "s": (375, 366)}
KEYS = cycle([*PRESSED.items(), *((key.upper(), pattern) for key, pattern in PRESSED.items())])
"""A key that was down when a robot changed does nothing for a while: so each time another one."""
COMMANDS = {"cmd_vel": (TwistStamped, Twist), "pwm": (Pwm, Int16MultiArray)}
SOURCES = ("keyboard", "program", "gamepad", "web", "buttons", "unknown")
COMMAND_KEYS = [f"robot/bench/{topic}/{source}" for topic, source in product(COMMANDS, SOURCES)]
REPORTS: dict[str, type[Message]] = {
    "beat": Beat,
    "vehicle": Vehicle,
    "odom": Odometry,
    "log": Log,
    "drive_status": DriveStatus,
}
HOSTILE = "\x1b]0;owned\x07\x1b[2J\x9b2J\r\n"

Say = Callable[..., None]
numbers = st.integers() | st.floats() | st.sampled_from([2**15, 2**53, 2**63, 2**64, 10**400, 1e308, 5e-324])
values = st.recursive(
    st.none() | st.booleans() | numbers | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)
payloads = st.binary(max_size=200) | values.map(lambda value: as_json(value))
encodings = st.sampled_from([codec.encoding_of(kind) for kind in MESSAGES.values()]) | st.text(max_size=40)
proofs = st.builds(
    struct.Struct("<QQQddd").pack, *[st.integers(0, 2**64 - 1)] * 3, *[st.floats(width=64)] * 3
)
attachments = st.none() | st.binary(max_size=100) | st.binary(min_size=48, max_size=48) | proofs


def as_json(value: Any) -> bytes:
    return json.dumps(value).encode()


def spoilt(value: Any) -> st.SearchStrategy[Any]:
    """Return messages of which some part is missing, of another type or out of all proportion."""
    if isinstance(value, dict):
        parts = {name: spoilt(part) for name, part in value.items()}
        return st.fixed_dictionaries(parts) | st.fixed_dictionaries({}, optional=parts)
    if isinstance(value, list):
        return st.lists(values, max_size=3) | st.lists(numbers, min_size=36, max_size=36)
    alike: dict[type, st.SearchStrategy[Any]] = {int: st.integers(), float: st.floats(), str: st.text()}
    return st.one_of(st.just(value), alike.get(type(value), values), numbers, values)


def spoilt_message(kind: type[Message]) -> st.SearchStrategy[tuple[bytes, str]]:
    zero = msgspec.to_builtins(kind.zero())
    return st.tuples(spoilt(zero).map(as_json), st.just(codec.encoding_of(kind)))


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("bad")) as bench:
        yield bench


@pytest.fixture(scope="module")
def actuator(rig: Rig) -> Process:
    return rig.actuator()


@pytest.fixture(scope="module")
def stranger(rig: Rig, actuator: Process) -> zenoh.Session:
    """Somebody on the bus without zteleop's manners."""
    return rig.session()


@pytest.fixture(scope="module")
def say(stranger: zenoh.Session) -> Say:
    """Say anything on any key."""

    def put(key: str, payload: bytes, encoding: str = "", attachment: bytes | None = None) -> None:
        stranger.put(key, payload, encoding=encoding, attachment=attachment, congestion_control=BLOCK)

    return put


@pytest.fixture(scope="module")
def operators(rig: Rig, actuator: Process) -> dict[type[Message], Publisher[Any]]:
    """The good ones, who are idle during an attack."""
    node = rig.node()
    rig.hear(node)
    return {
        Twist: node.publisher("cmd_vel", Twist, source="keyboard"),
        Pwm: node.publisher("pwm", Pwm, source="keyboard"),
    }


@pytest.fixture
def harmless(rig: Rig, actuator: Process, operators: dict[type[Message], Publisher[Any]]) -> Iterator[None]:
    """Judge an attack: no motion but the good one that follows on the same topics, and few words."""
    began, lines = time.monotonic(), len(actuator.lines)
    with Watch(rig) as watch:
        yield
        for command, pattern in GOOD:
            publisher = operators[type(command)]
            with repeating(lambda: publisher.publish(command), 0.02):  # noqa: B023
                until(lambda: rig.ticks == pattern, f"{command} on the chip")  # noqa: B023
            publisher.publish(Pwm(*NEUTRAL) if isinstance(command, Pwm) else Twist.planar())
            until(lambda: rig.ticks == NEUTRAL, "neutral")
    assert watch.seen <= {NEUTRAL, *(pattern for _, pattern in GOOD)}
    assert actuator.process.poll() is None, actuator.text
    assert len(actuator.lines) - lines <= LINES_A_SECOND * (time.monotonic() - began + 1)
    assert "Traceback" not in actuator.text


@pytest.fixture(scope="module")
def seats() -> list[Terminal]:
    """The keyboard that every attack so far has left good, if any."""
    return []


@pytest.fixture(scope="module")
def truth(rig: Rig, actuator: Process) -> Node:
    """Who hears what a keyboard hears."""
    return rig.node("truth")


@pytest.fixture
def keyboard(rig: Rig, truth: Node, seats: list[Terminal]) -> Iterator[Terminal]:
    """Judge an attack on who listens: it stays alive, its screen stays whole, and it drives."""
    seat = seats.pop() if seats else rig.keyboard()
    seat.shows("idle, nobody operates", f"{OUTPUT}[375, 370]")
    yield seat
    for kind in (Beat, Vehicle):
        hear(truth.subscription(kind.__name__.lower(), kind), lambda message: True, "the truth again")
    # Beats that crowd out the true ones are an interruption, and who presses first during one begins anew.
    hear(truth.subscription("drive_status", DriveStatus), lambda status: status.state == "idle", "free again")
    draw_anew(seat)
    key, pattern = next(KEYS)
    seat.type(key)
    until(lambda: rig.ticks == pattern, f"{key} on the chip")
    seat.shows("bench  step drive", "driving, you operate", f"{OUTPUT}{[*pattern]}", "q quit")
    for sequence in ("\x1b]", "\x9b", "\x1b[2Jidle", "\r\n", "Traceback"):
        assert sequence.encode() not in seat.output
    seat.type("x")
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    seats.append(seat)


def draw_anew(seat: Terminal) -> None:
    """Have the screen drawn, by whoever has read everything said before."""
    before = len(seat.output)
    seat.type("\x0c")
    until(lambda: b"\x1b[2J" in seat.output[before:], "a new screen")


def test_any_bytes_of_any_type_with_any_proof_move_nothing(say: Say, harmless: None) -> None:
    @settings(max_examples=300, deadline=None, database=None)
    @given(st.sampled_from(COMMAND_KEYS), payloads, encodings, attachments)
    def attack(key: str, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        say(key, payload, encoding, attachment)

    attack()


def test_commands_that_are_nearly_right_move_nothing(say: Say, harmless: None) -> None:
    commands = st.one_of(
        st.tuples(st.just(topic), spoilt_message(kind)) for topic, kinds in COMMANDS.items() for kind in kinds
    )

    @settings(max_examples=300, deadline=None, database=None)
    @given(commands, st.sampled_from(SOURCES), attachments)
    def attack(command: tuple[str, tuple[bytes, str]], source: str, attachment: bytes | None) -> None:
        topic, (payload, encoding) = command
        say(f"robot/bench/{topic}/{source}", payload, encoding, attachment)

    attack()


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"x" * 10_000_000,
        b'{"linear":' * 100_000,
        b"[" * 100_000 + b"]" * 100_000,
        b'{"linear":{"x":NaN,"y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
        b'{"linear":{"x":null,"y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
        b'{"linear":{"x":1e999,"y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
        b'{"linear":{"x":"1","y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
        b'{"linear":{"y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
        b'{"linear":{"x":1,"y":0,"z":0},"angular":{"x":0,"y":0,"z":1}}',
    ],
    ids=[
        "empty",
        "10 MB",
        "deep",
        "deeper",
        "NaN",
        "null",
        "infinite",
        "text",
        "a field missing",
        "no proof",
    ],
)
def test_a_twist_that_is_none_moves_nothing(say: Say, harmless: None, payload: bytes) -> None:
    for source in SOURCES:
        say(f"robot/bench/cmd_vel/{source}", payload, codec.encoding_of(Twist))


@pytest.mark.parametrize("data", [[], [400], ["a", "b"], [2**15, 0], [1.5, 2], None, {"0": 400}])
def test_controls_that_are_none_move_nothing(say: Say, harmless: None, data: object) -> None:
    for source in SOURCES:
        payload = as_json({"layout": {"dim": [], "data_offset": 0}, "data": data})
        say(f"robot/bench/pwm/{source}", payload, codec.encoding_of(Int16MultiArray))


def test_a_delete_is_no_command(stranger: zenoh.Session, harmless: None) -> None:
    for key in (*COMMAND_KEYS, "robot/bench/cmd_vel/**", "robot/**"):
        stranger.delete(key, congestion_control=BLOCK)


def test_commands_to_every_robot_at_once_move_none(say: Say, harmless: None) -> None:
    payload = msgspec.json.encode(Twist.planar(1.0, 1.0))
    for key in ("robot/*/cmd_vel/keyboard", "robot/bench/cmd_vel/*", "robot/bench/**", "robot/**", "**"):
        say(key, payload, codec.encoding_of(Twist), bytes(48))


def test_hundreds_of_names_for_one_key_are_not_hundreds_of_lines(say: Say, harmless: None) -> None:
    payload = msgspec.json.encode(Twist.planar(1.0, 1.0))
    for marks in product(("", "$*"), repeat=len("keyboard")):
        name = "".join(letter + mark for letter, mark in zip("keyboard", marks, strict=True))
        say(f"robot/bench/cmd_vel/{name}", payload, codec.encoding_of(Twist))


def test_a_flood_of_commands_without_proof_is_counted(rig: Rig, say: Say, harmless: None) -> None:
    statuses = rig.node().subscription("drive_status", DriveStatus)
    before = hear(statuses, lambda status: True, "a status").refused
    payload = msgspec.json.encode(Pwm(460, 500))
    for _ in range(5000):
        say("robot/bench/pwm/keyboard", payload, codec.encoding_of(Pwm))
    hear(statuses, lambda status: status.refused > before, "a refusal")


def test_a_keyboard_survives_any_bytes(say: Say, keyboard: Terminal) -> None:
    @settings(max_examples=200, deadline=None, database=None)
    @given(st.sampled_from([*REPORTS, "*", "**"]), payloads, encodings, attachments)
    def attack(topic: str, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        say(f"robot/bench/{topic}", payload, encoding, attachment)

    attack()


@pytest.mark.parametrize("topic", REPORTS)
def test_a_keyboard_survives_reports_that_are_nearly_right(say: Say, keyboard: Terminal, topic: str) -> None:
    @settings(max_examples=100, deadline=None, database=None)
    @given(spoilt_message(REPORTS[topic]))
    def attack(message: tuple[bytes, str]) -> None:
        say(f"robot/bench/{topic}", *message)

    attack()


@pytest.mark.parametrize(
    "report",
    [
        Beat(-1, 0.0, 0.0),
        Beat(2**64, 0.0, 0.0),
        Beat(1, 1e308, 0.0),
        msgspec.structs.replace(Vehicle.zero(), kind="ackermann"),
        msgspec.structs.replace(Vehicle.zero(), kind="differential"),
        Log(Log.zero().stamp, 255, HOSTILE, HOSTILE, "", "", 0),
        msgspec.structs.replace(DriveStatus.zero(), why=HOSTILE, source=HOSTILE, operator=HOSTILE),
        Odometry.zero(),
    ],
    ids=lambda report: f"{report}"[:30].encode("unicode_escape").decode(),
)
def test_a_keyboard_survives_a_liar(rig: Rig, say: Say, keyboard: Terminal, report: Message) -> None:
    topic = next(topic for topic, kind in REPORTS.items() if kind is type(report))
    encoding, payload = codec.encoding_of(type(report)), as_json(msgspec.to_builtins(report))
    said = []

    def lie() -> None:
        said.append(say(f"robot/bench/{topic}", payload, encoding))

    with repeating(lie, 0.02):
        keyboard.type(LEFT + "x")
        until(lambda: len(said) > 10, "a lie that is long enough")


def test_a_keyboard_survives_what_is_too_much(say: Say, keyboard: Terminal) -> None:
    for topic, kind in REPORTS.items():
        for payload in (b"x" * 10_000_000, b"[" * 100_000, as_json({"msg": "x" * 100_000})):
            say(f"robot/bench/{topic}", payload, codec.encoding_of(kind))


def test_a_robot_whose_pulses_fit_no_period_does_not_start(rig: Rig) -> None:
    (rig.folder / "fast.toml").write_text("[drivers.simulated]\nfrequency_hz = 600\n")
    refused = rig.result("actuator", "--config", "fast.toml", "--no-multicast-scouting")
    assert (refused.returncode, refused.stdout) == (1, "")
    assert refused.stderr == (
        "zteleop actuator: drive.servos.throttle: its longest pulse, 2040 us, does not fit a period of "
        "1638 us; lower the driver's frequency_hz\n"
    )
