"""A node on a session that is none: what it declares, resolves and refuses. Its travels are system tests."""

import re
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from unit.bus.fakes import Outlet, Session, sample

import zteleop
from zteleop.bus import codec, presence, rclpy_names
from zteleop.bus.heard import Heard
from zteleop.bus.names import known_as
from zteleop.bus.node import Node
from zteleop.bus.settings import BusSettings
from zteleop.errors import ConfigError, MessageError
from zteleop.machine import stderr
from zteleop.messages import Beat, Int16MultiArray, Log, Odometry, Pwm, String, Twist, TwistStamped
from zteleop.testing import Clock

HEARD = ("beat", "vehicle", "refusals")


@pytest.fixture
def session(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> Session:
    monkeypatch.setattr(Heard, "wait", lambda heard, tell: heard.listen())
    return Session()


@pytest.fixture
def node(session: Session) -> Iterator[Node]:
    with Node("nose", "archangel", session=session) as node:
        yield node


@pytest.fixture
def stranger(session: Session) -> Iterator[Node]:
    with Node("nose", session=session) as node:
        yield node


def said(session: Session, key: str) -> Outlet:
    return session.outlets[key][0]


def test_a_node_of_a_robot_is_present_and_can_speak(node: Node, session: Session) -> None:
    assert presence.holders(session, "archangel", "nose") == [presence.process()]
    assert list(session.outlets) == ["robot/archangel/log"]


def test_a_node_with_a_bad_link_says_nothing_on_a_better_one(node: Node, session: Session) -> None:
    worse = Outlet()
    node.membership.link = lambda outlet: worse
    node.publisher("chatter", String).publish(String("hello"))
    assert len(worse.puts) == 1
    assert said(session, "robot/archangel/chatter").puts == []


def test_a_command_echoes_what_whoever_acts_has_heard(node: Node, session: Session, clock: Clock) -> None:
    older = Beat(1, 5.0, 0.0)
    node.membership.echo = lambda heard: SimpleNamespace(beat=older, vehicle=None, awake_since=0.0)
    motors = node.publisher("cmd_vel", Twist, source="web", wait=False)
    motors.publish(Twist.planar(0.1))
    proof = codec.unpack_proof(said(session, "robot/archangel/cmd_vel/web").puts[0].attachment)
    assert proof is not None
    assert (proof.epoch, proof.beat) == (1, 5.0)


@pytest.mark.parametrize(("source", "told"), [("web", 0), ("keyboard", 0), ("program", 1), ("planner", 1)])
def test_whoever_is_no_input_is_told_what_no_wheels_do(
    node: Node, session: Session, source: str, told: int
) -> None:
    lines: list[str] = []
    node.log.show = lines.append
    asked = Twist.planar(0.1)
    asked.linear.y = 0.1
    node.publisher("cmd_vel", Twist, source=source, wait=False).publish(asked)
    assert sum("linear.y 0.1; a robot on wheels obeys linear.x" in line for line in lines) == told


def test_a_node_without_a_robot_is_nobodys(stranger: Node, session: Session) -> None:
    assert session.alive == []
    stranger.log.warn("smells odd")
    assert session.outlets == {}


@pytest.mark.parametrize("name", ["", "a/b", "*", "-a", "a b"])
def test_a_nodes_name_is_checked_before_it_joins(name: str) -> None:
    with pytest.raises(ConfigError, match="a node's name is made of"):
        Node(name)


def test_a_robots_name_is_checked_before_it_joins() -> None:
    with pytest.raises(ConfigError, match="a robot's name is"):
        Node("nose", "*")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("create_timer", r"a Node has no create_timer: here it is node.every\(period\), before a function"),
        ("create_publisher", r"here it is node.publisher\(topic, type\) \(docs/rclpy.md shows both\)$"),
        ("zebra", "^a Node has no zebra$"),
    ],
)
def test_names_of_rclpy_are_told_what_they_are_here(node: Node, name: str, words: str) -> None:
    with pytest.raises(AttributeError, match=words):
        getattr(node, name)


def test_what_a_node_of_rclpy_has_is_told_by_a_name_that_a_node_has(node: Node) -> None:
    for here in rclpy_names.HERE.values():
        assert hasattr(node, re.match(r"\w+", here)[0])  # type: ignore[index]


@pytest.mark.parametrize("spins", [True, False])
def test_a_program_that_never_spins_is_told_what_it_does_in_vain(session: Session, spins: bool) -> None:
    lines: list[str] = []
    with Node("nose", session=session) as node:
        node.log.show = lines.append
        node.every(1.0)(lambda: None)
        node.on("archangel/odom", Odometry)(print)
        if spins:
            node.spin(0.0)
    words = "nothing of archangel/odom was handled: node.spin() runs what waits, and was not called"
    assert bool([line for line in lines if words in line]) is not spins


def test_a_program_that_failed_is_told_of_nothing_else(session: Session) -> None:
    lines: list[str] = []

    def fail() -> None:
        with Node("nose", session=session) as node:
            node.log.show = lines.append
            node.every(1.0)(lambda: None)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert lines == []


def test_a_queue_of_rclpy_is_told_where_it_belongs(node: Node) -> None:
    with pytest.raises(ConfigError, match=r"^publisher\(topic, type\) keeps no queue, found 10: who hears"):
        node.publisher("note", String, 10)
    node.subscription("note", String, print, 10)


def test_a_function_that_is_given_as_in_rclpy_is_decorated_at_once(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    handed: list[Callable[[object], object]] = []
    heard: list[object] = []
    monkeypatch.setattr(node.membership, "deliver", lambda inbox, handler: handed.append(handler))
    node.on("odom", Odometry, heard.append)
    handed[0](SimpleNamespace(message="a message"))
    assert heard == ["a message"]
    node.every(1e-9, node.stop)
    node.spin()


def test_the_length_of_a_queue_is_no_function(node: Node) -> None:
    words = "expected a function, found 10; how many are kept is depth="
    with pytest.raises(ConfigError, match=words):
        node.on("odom", Odometry, 10)  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match=words):
        node.every(0.1, 10)  # type: ignore[arg-type]


def test_who_swaps_topic_and_type_is_told_so_before_all_else(node: Node) -> None:
    with pytest.raises(ConfigError, match=r"expected a topic's name, such as 'cmd_vel', and then its type"):
        node.publisher(Twist, "cmd_vel", 10)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["init", "spin", "ok"])
def test_what_modules_of_ros_have_is_told_what_it_is_here(name: str) -> None:
    with pytest.raises(AttributeError, match=rf"^zteleop has no '{name}': here it is .* \(docs/rclpy.md\)$"):
        getattr(zteleop, name)


def test_with_leaves_the_bus(session: Session) -> None:
    def fail() -> None:
        with Node("nose", session=session):
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert session.closed


@pytest.mark.parametrize(
    ("topic", "source", "key"),
    [
        ("cmd_vel", "program", "robot/archangel/cmd_vel/program"),
        ("cmd_vel_stamped", "keyboard", "robot/archangel/cmd_vel/keyboard"),
        ("/zoe/cmd_vel", "web", "robot/zoe/cmd_vel/web"),
        ("cmd_vel/nav", "web", "robot/archangel/cmd_vel/nav"),
    ],
)
def test_a_command_goes_out_under_its_source(
    node: Node, session: Session, topic: str, source: str, key: str
) -> None:
    node.publisher(topic, Twist, source=source)
    assert key in session.outlets


@pytest.mark.parametrize(("command", "words"), [(Twist.planar(0.3), 2), (Twist.planar(), 1), (None, 0)])
def test_whoever_leaves_in_order_lets_go_of_what_moves_and_says_no_more_than_that(
    session: Session, command: Twist | None, words: int
) -> None:
    with Node("nose", "archangel", session=session) as node:
        motors = node.publisher("cmd_vel", Twist)
        if command:
            motors.publish(command)
    puts = said(session, "robot/archangel/cmd_vel/program").puts
    assert len(puts) == words
    if puts:
        last = codec.decode(puts[-1].payload, puts[-1].encoding, codec.decoders([Twist]))
        assert last == Twist.planar()


def test_commands_overtake(node: Node, session: Session) -> None:
    node.publisher("pwm", (Pwm, Int16MultiArray))
    node.publisher("odom", Odometry)
    command, plain = (session.outlets[f"robot/archangel/{path}"][1] for path in ("pwm/program", "odom"))
    assert (command, plain) == (True, False)


def test_each_publisher_of_commands_is_a_sender_of_its_own(node: Node) -> None:
    assert node.publisher("odom", Odometry).sender == ""
    senders = {node.publisher("cmd_vel", Twist, source=f"s{n}").sender for n in range(3)}
    assert len(senders) == 3
    assert "" not in senders


def test_a_type_that_a_topic_does_not_take_is_refused_by_name(node: Node) -> None:
    with pytest.raises(ConfigError, match=r"^cmd_vel takes TwistStamped or Twist, found Twist, Pwm$"):
        node.publisher("cmd_vel", (Twist, Pwm))


def test_a_topic_of_no_table_takes_any_type(node: Node, session: Session) -> None:
    node.publisher("chatter", String).publish(String("hello"))
    (put,) = said(session, "robot/archangel/chatter").puts
    assert (put.payload, put.attachment) == (b'{"data":"hello"}', None)


@pytest.mark.parametrize("source", ["*", "a/b", "", "**", "a b"])
def test_a_source_is_one_part_of_a_key(node: Node, source: str) -> None:
    with pytest.raises(ConfigError, match="a source is made of"):
        node.publisher("cmd_vel", Twist, source=source)


@pytest.mark.parametrize("topic", ["*", "cmd_vel/**", "*/odom", "robot/**"])
def test_no_wildcard_reaches_a_key(node: Node, topic: str) -> None:
    for declare in (node.publisher, node.subscription):
        with pytest.raises(ConfigError):
            declare(topic, Twist)


@pytest.mark.parametrize(
    ("topic", "key"),
    [
        ("cmd_vel", "robot/archangel/cmd_vel/**"),
        ("controls", "robot/archangel/pwm/**"),
        ("cmd_vel/web", "robot/archangel/cmd_vel/web"),
        ("/zoe/odom", "robot/zoe/odom"),
    ],
)
def test_the_plain_name_of_a_command_means_all_its_sources(
    node: Node, session: Session, topic: str, key: str
) -> None:
    node.subscription(topic, (TwistStamped, Twist))
    assert list(session.rings) == [key]


def test_what_a_node_publishes_and_hears_is_told(node: Node, session: Session) -> None:
    node.publisher("odom", Odometry)
    node.subscription("cmd_vel", (TwistStamped, Twist))
    told = {(end.kind, end.node, end.type, end.topic) for end in presence.endpoints(session)}
    assert told == {
        ("pub", "nose", "rcl_interfaces/msg/Log", "log"),
        ("pub", "nose", "nav_msgs/msg/Odometry", "odom"),
        ("sub", "nose", "geometry_msgs/msg/TwistStamped", "cmd_vel/**"),
        ("sub", "nose", "geometry_msgs/msg/Twist", "cmd_vel/**"),
    }


def test_what_is_dropped_is_said_once_a_second_for_each_key(
    node: Node, session: Session, capfd: pytest.CaptureFixture[str]
) -> None:
    inbox = node.subscription("odom", Odometry)
    session.rings["robot/archangel/odom"].samples += [sample(String("x"), "robot/archangel/odom")] * 5
    assert inbox.newest() is None
    assert inbox.dropped == 5
    logs = said(session, "robot/archangel/log").puts
    assert len(logs) == 1
    log = codec.decode(logs[0].payload, logs[0].encoding, codec.decoders([Log]))
    words = "robot/archangel/odom: dropped: expected nav_msgs/msg/Odometry, found 'std_msgs/msg/String'"
    assert log.msg == words
    stderr.flush()
    assert capfd.readouterr().err == f"nose: warning: {words}\n"


@pytest.mark.parametrize("period", [0, -1.0, float("nan"), len])
def test_a_timer_needs_a_period(node: Node, period: float) -> None:
    with pytest.raises(ConfigError, match=r"a timer's period is in s, as in @node\.every"):
        node.every(period)


def test_every_and_stop(node: Node, clock: Clock) -> None:
    ticks = []

    @node.every(1e-9)
    def tick() -> None:
        clock.pass_by(0.1)
        ticks.append(clock.time)
        if len(ticks) == 3:
            node.stop()

    node.spin()
    assert len(ticks) == 3


def test_an_alarm_rings_in_spin(node: Node, clock: Clock) -> None:
    node.membership.loop.alarm(node.stop).ring_at(clock.time)
    node.spin()


def test_what_is_heard_of_a_robot_is_heard_once(node: Node, session: Session) -> None:
    assert node.membership.heard() is node.membership.heard("archangel")
    assert node.membership.heard("zoe") is not node.membership.heard()
    assert set(session.rings) == {f"robot/{r}/{t}" for r in ("archangel", "zoe") for t in HEARD}


def test_without_a_robot_nobody_is_heard(stranger: Node) -> None:
    with pytest.raises(ConfigError, match=r"node nose has no robot; say Node\('nose', robot=\.\.\.\)"):
        stranger.membership.heard()


def test_a_handlers_command_echoes_the_beat_heard_before_it_began(node: Node, session: Session) -> None:
    """What a slow handler decides must not pass for newer than what it saw."""
    publisher = node.publisher("cmd_vel", Twist)
    beats = session.rings["robot/archangel/beat"].samples
    beats.append(sample(Beat(1, 5.0, 0.0)))

    def handle() -> None:
        beats.append(sample(Beat(1, 6.0, 0.0)))
        publisher.publish(Twist.planar(0.5))
        node.stop()

    node.membership.loop.call_soon(handle)
    node.spin()
    publisher.publish(Twist.planar(0.5))
    puts = said(session, "robot/archangel/cmd_vel/program").puts
    assert [codec.unpack_proof(put.attachment).beat for put in puts] == [5.0, 6.0]


def test_the_page_shows_all_of_a_node() -> None:
    page = (Path(__file__).parents[3] / "docs/programs.md").read_text()
    table = page[page.index("## All of a node") : page.index("## Without a robot")]
    shown = set(re.findall(r"node\.(\w+)", table))
    public = {
        name for name in (*vars(Node), *vars(Node("nose", session=Session()))) if not name.startswith("_")
    }
    assert shown == public - {"membership"}


@pytest.mark.parametrize(
    ("topic", "meant"),
    [
        ("cmd_vell", "cmd_vel"),
        ("drive-status", "drive_status"),
        ("chatter", ""),
        ("poses", ""),
        ("odom2", "odom"),
    ],
)
def test_a_topic_that_is_nearly_a_known_one_is_asked_about(topic: str, meant: str) -> None:
    assert known_as(topic) == meant


def test_whoever_publishes_a_misspelt_topic_is_told_and_not_who_writes_all_of_it(
    node: Node,
) -> None:
    lines: list[str] = []
    node.log.show = lines.append
    for topic in ("cmd_vell", "/cmd_vell", "/archangel/cmd_vell"):
        node.publisher(topic, Twist)
    told = [line.partition("publishes ")[2] for line in lines]
    assert told == [
        f"{name}, which no robot hears; did you mean cmd_vel?" for name in ("cmd_vell", "/cmd_vell")
    ]


@pytest.mark.parametrize("kind", ["Odometry", Odometry.zero(), int, None])
def test_what_is_no_type_of_message_is_named(node: Node, kind: object) -> None:
    for ask in (node.subscription, node.publisher, lambda topic, types: node.on(topic, types)(print)):
        with pytest.raises(MessageError, match=r"^expected a type of message, such as .*, found "):
            ask("odom", kind)  # type: ignore[operator]


def test_whoever_listens_to_a_misspelt_topic_is_told(node: Node) -> None:
    lines: list[str] = []
    node.log.show = lines.append
    node.on("odmo", Odometry)(print)
    node.subscription("chatter", String)
    (line,) = lines
    assert line.endswith("hears odmo, which no robot says; did you mean odom?")


def test_a_program_whose_robot_is_not_heard_learns_that_it_reads_no_settings(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("zteleop.bus.node.open_session", lambda bus: session)
    told: list[str] = []
    for bus in (None, BusSettings(connect=["tcp/pi:7447"])):
        with Node("nose", "archangel", bus) as node:
            node.log.show = told.append
            node.publisher("cmd_vel", Twist)
    assert ["it reads no config.toml" in words for words in told] == [True, False]


def test_who_looks_beside_a_node_ends_with_it_and_what_is_gone_by_then_is_no_error(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[object] = []
    monkeypatch.setattr(threading, "excepthook", told.append)
    begun, closed = threading.Event(), threading.Event()

    def look() -> float:
        begun.set()
        closed.wait()
        raise OSError("its ring is gone")

    before = set(threading.enumerate())
    node.membership.beside(look)
    (beside,) = set(threading.enumerate()) - before
    begun.wait()
    node.close()
    closed.set()
    beside.join()
    assert told == []


def test_what_goes_wrong_beside_a_node_that_is_open_is_told(
    node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[object] = []
    monkeypatch.setattr(threading, "excepthook", told.append)
    before = set(threading.enumerate())
    begin = threading.Event()
    node.membership.beside(lambda: begin.wait() and 1 / 0)
    (beside,) = set(threading.enumerate()) - before
    begin.set()
    beside.join()
    assert len(told) == 1


@pytest.mark.parametrize(("source", "looks"), [("program", 2), ("planner", 2), ("keyboard", 0)])
def test_somebody_looks_after_a_program_and_after_no_operator(
    node: Node, monkeypatch: pytest.MonkeyPatch, source: str, looks: int
) -> None:
    besides: list[object] = []
    monkeypatch.setattr(node.membership, "beside", besides.append)
    node.publisher("cmd_vel", Twist, source=source)
    assert len(besides) == looks
