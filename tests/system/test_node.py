"""Programs that people write with `Node`, each a process of its own beside a running actuator."""

import re
import signal
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Process, Rig, Watch, hear, until

from zteleop.bus.node import Node
from zteleop.control.command import STEERS_ONLY
from zteleop.errors import ConfigError, MessageError
from zteleop.messages import DriveStatus, Pwm, String, Twist, TwistStamped

FULL_LEFT = (460, 370)
"""What a turn means to a car that stands."""

TURNING = """
with node:
    motors = node.publisher("cmd_vel", Twist)

    @node.every({period})
    def turn() -> None:
        motors.publish(Twist.planar(angular=1.0))

    node.spin()
"""
READING = """
with node:
    notes = node.subscription("note", String)
    print("listening", flush=True)
    for message in notes:
        print("heard", message.data, flush=True)
        if message.data == "last":
            break
"""
RAISING = """
with node:
    @node.on("note", String)
    def handle(note: String) -> None:
        raise RuntimeError(f"cannot handle {note.data}")

    print("listening", flush=True)
    node.spin()
"""
RAISING_TIMER = """
with node:
    @node.every(0.01)
    def fail() -> None:
        raise RuntimeError("cannot handle time")

    node.spin()
"""
BLOCKING = """
with node:
    motors = node.publisher("cmd_vel", Twist)

    @node.on("note", String)
    def handle(note: String) -> None:
        time.sleep(1.0)
        motors.publish(Twist.planar(angular=1.0))
        print("published", flush=True)

    print("listening", flush=True)
    node.spin()
"""
NEWEST = """
with node:
    @node.on("newest", String, depth=1)
    def handle(note: String) -> None:
        print("heard", note.data, flush=True)
        time.sleep(1.0)

    print("listening", flush=True)
    node.spin()
"""
BEHIND = """
with node:
    {hail}:
        print("heard", note.data, flush=True)
        time.sleep(0.3)

    print("listening", flush=True)
    node.spin()
"""
WEATHER = """
with node:
    node.on("weather", String)(print)
    node.spin()
"""
IDLE = """
with node:
    for topic in ("cmd_vel", "pwm"):
        node.subscription(topic, TwistStamped if topic == "cmd_vel" else Pwm, lambda received: None)
    print("listening", flush=True)
    {ending}
"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("node")) as bench:
        bench.set("blackbox = false")  # it hears whoever publishes: nobody could be awaited by that
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def node(rig: Rig) -> Node:
    """A node in this process."""
    node = rig.node()
    rig.hear(node)
    return node


def program(rig: Rig, text: str) -> Process:
    start = f"""
import time
from zteleop import BusSettings, Node, Pwm, Twist, TwistStamped
from zteleop.bus import clock
from zteleop.messages import String

node = Node("program", robot="bench", bus=BusSettings(connect=["{rig.endpoint}"], multicast=False))
"""
    return rig.program(start + text)


def test_who_is_slow_may_hear_the_newest_alone(rig: Rig, node: Node) -> None:
    slow = program(rig, NEWEST)
    slow.says("listening")
    say(node, "newest", "first")
    slow.says("heard first")
    say(node, "newest", *(f"number {n}" for n in range(20)), "last")
    slow.says("heard last")
    assert slow.text.count("heard") <= 3, "one may have been on its way"


def test_a_loop_over_messages_ends_with_its_node_whatever_its_body_was_at(rig: Rig, node: Node) -> None:
    short = rig.node("short")
    notes = iter(short.subscription("short", String))
    say(node, "short", "one")
    assert next(notes) == String("one")
    short.close()
    assert list(notes) == []


@pytest.mark.parametrize(
    "hail",
    [
        '@node.on("hail", String)\n    def handle(note: String) -> None',
        'print("listening", flush=True)\n    for note in node.subscription("hail", String)',
    ],
    ids=["handler", "loop"],
)
def test_who_cannot_follow_what_he_hears_is_told_so(rig: Rig, node: Node, hail: str) -> None:
    slow = program(rig, BEHIND.replace("{hail}", hail))
    slow.says("listening")
    say(node, "hail", *(f"number {n}" for n in range(9)))
    said = slow.says("robot/bench/hail: messages come faster than this program takes them (")
    assert "program: warning: " in said  # behind a part of what the program itself was just printing
    slow.signal(signal.SIGINT)
    slow.ends()


def test_who_waits_for_what_nobody_says_is_told_and_when_it_is_said_and_when_no_more(rig: Rig) -> None:
    waits = program(rig, WEATHER)
    waits.says("nobody publishes bench/weather (zteleop list -v shows what is said, and by whom)")
    station = rig.join("pub", "weather", "String", "{data: fair}", "-r", "5")
    waits.says("bench/weather is published now")
    station.signal(signal.SIGINT)
    waits.says("nobody publishes bench/weather any more")
    assert waits.text.count("nobody publishes") == 2


def say(node: Node, topic: str, *texts: str) -> None:
    """Say something to a program that says `listening`."""
    publisher = node.publisher(topic, String)
    until(lambda: publisher.matched, "somebody who listens")
    for text in texts:
        publisher.publish(String(text))


def test_a_program_drives_as_source_program_and_ends_at_sigterm(rig: Rig, node: Node) -> None:
    statuses = node.subscription("drive_status", DriveStatus)
    turner = program(rig, TURNING.format(period=0.1))
    until(lambda: rig.ticks == FULL_LEFT, "the wheels to the left")
    status = hear(statuses, lambda status: status.state == "driving", "who drives")
    assert (status.source, status.why) == ("program", f"program {status.operator[-4:]} drives")
    turner.signal(signal.SIGTERM)
    assert turner.ends() == 143
    over = hear(statuses, lambda status: status.state != "driving", "the end")
    assert (over.state, over.why) == ("idle", "nobody drives"), "it left in order, and is not lost"
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    (told,) = turner.lines
    assert told.endswith("turns front wheels and moves nothing: " + STEERS_ONLY), "and nothing else"


def test_a_program_reads_messages_in_a_for_loop_in_order(rig: Rig, node: Node) -> None:
    reader = program(rig, READING)
    reader.says("listening")
    say(node, "note", "first", "second", "last")
    assert reader.ends() == 0
    assert reader.lines == ["listening", "heard first", "heard second", "heard last"]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_program_that_waits_in_a_for_loop_can_be_ended(rig: Rig, number: int) -> None:
    reader = program(rig, READING)
    reader.says("listening")
    reader.signal(number)
    assert reader.ends() in (143, 130)


@pytest.mark.parametrize(
    ("ending", "code"),
    [("pass", 0), ("raise SystemExit(7)", 7), ("raise KeyError('boom')", 1), ("node.close()", 0)],
    ids=["falls off its end", "SystemExit", "an exception", "closes twice"],
)
def test_the_process_ends_with_its_with(rig: Rig, ending: str, code: int) -> None:
    idler = program(rig, IDLE.format(ending=ending))
    assert idler.ends() == code
    assert idler.text.count("Traceback") == (code == 1)


def test_a_handler_that_raises_ends_the_program_with_its_traceback(rig: Rig, node: Node) -> None:
    raiser = program(rig, RAISING)
    raiser.says("listening")
    say(node, "note", "this")
    assert raiser.ends() == 1
    assert "Traceback (most recent call last):" in raiser.text
    assert raiser.lines[-1] == "RuntimeError: cannot handle this"
    files = re.findall(r'File "(.*?)"', raiser.text)
    assert len(files) == 3, "the program, spin, and the program's handler"


def test_a_timer_that_raises_ends_the_program_with_its_traceback(rig: Rig) -> None:
    raiser = program(rig, RAISING_TIMER)
    assert raiser.ends() == 1
    assert raiser.lines[-1] == "RuntimeError: cannot handle time"


def test_what_a_handler_says_after_a_long_pause_moves_nothing(rig: Rig, node: Node) -> None:
    """What it knew of the robot is as old as the message it handles."""
    statuses = node.subscription("drive_status", DriveStatus)
    blocker = program(rig, BLOCKING)
    blocker.says("listening")
    with Watch(rig) as watch:
        say(node, "note", "go")
        blocker.says("published")
        refused = hear(statuses, lambda status: " is refused" in status.why, "a refusal")
    assert "the command is too old" in refused.why
    assert watch.seen == {NEUTRAL}


def test_what_cannot_be_said_is_an_error_for_who_says_it(node: Node) -> None:
    motors = node.publisher("cmd_vel", (TwistStamped, Twist))
    with pytest.raises(MessageError, match=r"expected a finite number, found nan at Twist\.linear\.x"):
        motors.publish(Twist.planar(float("nan")))
    with pytest.raises(MessageError, match="expected TwistStamped or Twist, found Pwm"):
        motors.publish(Pwm(375, 370))  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match=r"cmd_vel takes TwistStamped or Twist, found Pwm"):
        node.publisher("cmd_vel", Pwm)


def test_a_message_of_another_type_is_dropped_counted_and_said(rig: Rig, node: Node) -> None:
    said: list[str] = []
    listener = rig.node("listener")
    listener.log.show = said.append
    notes = listener.subscription("soil", Pwm)
    say(node, "soil", "dry", "wet")
    until(lambda: not list(notes.take()) and notes.dropped == 2, "two drops")
    (line,) = said
    assert re.search(
        r"robot/bench/soil: dropped: expected zteleop_msgs/msg/Pwm, found 'std_msgs/msg/St", line
    )


@pytest.mark.parametrize("time", range(8))
def test_a_program_that_fails_without_a_with_ends_as_any_other_does(rig: Rig, time: int) -> None:
    """Callbacks that came into Python's own end aborted one in four, without a word."""
    bus = f"BusSettings(connect=[{rig.endpoint!r}], multicast=False)"
    program = rig.program(
        f"from zteleop import BusSettings, Node\nnode = Node('odd', {rig.robot!r}, {bus})\n1 / 0"
    )
    assert program.ends() == 1
    assert program.lines[-1] == "ZeroDivisionError: division by zero"


ONCE = """
node = Node("once", robot={robot!r}, bus=BusSettings(connect=[{endpoint!r}], multicast=False))
motors = node.publisher("cmd_vel", Twist)
motors.publish(Twist.planar(linear=0.3))
"""
ONE_TIMER = """
node = Node("once", bus=BusSettings(connect=[{endpoint!r}], multicast=False))

@node.every(0.1)
def turn() -> None:
    raise AssertionError
"""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (ONCE, "what was said on cmd_vel held for "),
        (ONE_TIMER, "turn() never ran: node.spin() runs what waits, and was not called"),
    ],
)
def test_a_program_without_a_with_ends_in_order_and_is_told_what_was_in_vain(
    rig: Rig, text: str, words: str
) -> None:
    where = text.format(robot=rig.robot, endpoint=rig.endpoint)
    program = rig.program(f"from zteleop import BusSettings, Node, Twist\n{where}")
    assert program.ends() == 0
    assert f"once: warning: {words}" in program.text


def test_a_program_is_told_of_a_source_that_its_robot_has_not(rig: Rig) -> None:
    lidar = program(rig, 'with node:\n    node.publisher("cmd_vel/lidar", Twist)')
    assert lidar.ends() == 0
    assert "robot bench has no source 'lidar'; known: " in lidar.text
    assert "[drive.sources.lidar] in its config.toml adds one" in lidar.text


def test_a_type_in_the_place_of_a_name_is_said_to_be_one(rig: Rig) -> None:
    turned = program(rig, 'with node:\n    node.publisher(Twist, "cmd_vel")')
    assert turned.ends() == 1
    assert "expected a topic's name, such as 'cmd_vel', and then its type; found <class" in turned.lines[-1]
