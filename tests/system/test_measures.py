"""hz, bw, delay, info, type, find, node and interface: asked of real robots by real processes."""

import re
import shlex
import signal
import subprocess
from collections.abc import Iterator

import pytest
from rig import NEUTRAL, PATIENCE, ZTELEOP, Process, Rig, Watch, repeating, until

from zteleop.bus import presence
from zteleop.bus.names import Name
from zteleop.messages import Header, String, Time, Twist, TwistStamped

HZ = 50.0


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("measures")) as bench:
        bench.actuator()
        yield bench


def ask(rig: Rig, line: str, code: int = 0) -> str:
    result = rig.result(*shlex.split(line), *rig.bus_options())
    assert result.returncode == code, result
    return result.stdout if code == 0 else result.stderr


def ended(process: Process) -> str:
    process.signal(signal.SIGINT)
    assert process.ends() == 130, process.text
    return process.text


def test_hz_and_bw_and_delay_measure_what_a_publisher_does(rig: Rig) -> None:
    talker = rig.node()
    chatter, poses = talker.publisher("chatter", String), talker.publisher("commanded", TwistStamped)

    def talk() -> None:
        chatter.publish(String("x" * 89))  # 100 bytes of JSON
        poses.publish(TwistStamped(Header(Time(1, 0), "base_link"), TwistStamped.zero().twist))

    verbs = {verb: rig.join(*words.split()) for verb, words in MEASURES.items()}
    with repeating(talk, 1 / HZ):
        for verb, process in verbs.items():
            until(lambda process=process: len(process.lines) >= 4, f"lines of {verb}")
    said = {verb: ended(process) for verb, process in verbs.items()}
    rates = [float(rate) for rate in re.findall(r"average rate: ([0-9.]+)", said["hz"])]
    assert abs(rates[-1] - HZ) < HZ / 10, said["hz"]
    assert re.search(r"\tmin: 0\.\d{3}s max: \d\.\d{3}s std dev: 0\.\d{5}s window: \d+", said["hz"])
    assert "Subscribed to [/bench/chatter]\n" in said["bw"]
    assert "Message size mean: 100 B min: 100 B max: 100 B" in said["bw"] or "0.10 KB" in said["bw"]
    ages = [float(age) for age in re.findall(r"average delay: ([0-9.]+)", said["delay"])]
    assert min(ages) > 1e9, "the stamp was of 1970"
    assert re.search(r"^/bench/chatter +\d", said["table"], re.MULTILINE), said["table"]
    assert re.search(r"^/bench/nothing +not heard$", said["table"], re.MULTILINE), said["table"]


def test_latency_follows_a_program_from_the_robots_door_to_its_chip(rig: Rig) -> None:
    motors = rig.node().publisher("cmd_vel", TwistStamped)

    def drive() -> None:
        motors.publish(TwistStamped(Header(Time(1, 0), "base_link"), Twist.planar(0.2)))

    latency = rig.join("latency")
    until(lambda: "nobody drives" in latency.text, "a line before anybody drives")
    with repeating(drive, 1 / HZ):
        until(lambda: re.search(r"^program \w{4} ", latency.text, re.MULTILINE), "a line of the program")
        whole = r"^program \w{4} +- +(\S+) +(\d\S+) +(\d\S+) +(\d\S+) +(\d\S+)$"
        until(lambda: re.search(whole, latency.text, re.MULTILINE), "all parts")
    motors.let_go()
    network, door, chip, in_all, worst = map(float, re.findall(whole, ended(latency), re.MULTILINE)[-1])
    assert in_all == pytest.approx(network + door + chip, abs=0.02)
    assert worst >= in_all >= chip > 0


def test_a_simulator_on_a_bad_radio_is_heard_late(rig: Rig) -> None:
    sim = rig.join("sim", "--latency", "300ms", "--loss", "20%")
    sim.says("moves bench")
    delay = rig.join("delay", "odom")
    until(lambda: re.search(r"average delay: 0\.3", delay.text), "odometry that is 0.3 s old")
    with_losses = rig.join("hz", "odom")
    until(lambda: re.search(r"average rate: 1[4-8]\.", with_losses.text), "four of five of 20 a second")
    for process in (delay, with_losses):
        ended(process)
    ended(sim)


MEASURES = {
    "hz": "topic hz chatter",
    "bw": "bw chatter",
    "delay": "delay commanded",
    "table": "hz chatter nothing",
}


def test_a_topic_without_stamps_is_said_to_have_none(rig: Rig) -> None:
    delay = rig.join("delay", "drive_status")
    until(lambda: "msg does not have header" in delay.text, "words")
    ended(delay)


def test_whoever_measures_silence_is_told_for_whom_it_waits(rig: Rig) -> None:
    hz = rig.join("hz", "drive_statu")
    until(lambda: "waits for bench/drive_statu" in hz.text, "words")
    assert "did you mean drive_status?" in ended(hz)


def test_the_graph_is_complete_the_first_time(rig: Rig) -> None:
    info = ask(rig, "topic info drive_status")
    assert info.splitlines()[:2] == ["Type: zteleop_msgs/msg/DriveStatus", "Publisher count: 1"]
    assert "Node name: actuator\n" in ask(rig, "info /bench/drive_status -v")
    assert ask(rig, "topic type cmd_vel").splitlines() == [
        "geometry_msgs/msg/TwistStamped",
        "geometry_msgs/msg/Twist",
    ]
    assert ask(rig, "topic find Twist") == "/bench/cmd_vel\n"
    assert ask(rig, "find nav_msgs/msg/Odometry -c") == "0\n"
    nodes = ask(rig, "node list").splitlines()
    assert {"/bench/actuator", "/bench/watchdog", "/bench/blackbox"} <= set(nodes)
    assert ask(rig, "node list --count-nodes") == f"{len(nodes)}\n"
    assert "    whatever is said on /bench" in ask(rig, "node info blackbox")
    told = ask(rig, "node info actuator")
    assert told.startswith("/bench/actuator\n  Subscribers:\n    /bench/cmd_vel/")
    assert "    /bench/drive_status: zteleop_msgs/msg/DriveStatus\n" in told.partition("  Publishers:\n")[2]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("info drive_statu", "zteleop info: Unknown topic '/bench/drive_statu'; did you mean drive_status?"),
        ("type odom", "zteleop type: Unknown topic '/bench/odom'; nobody publishes it, or hears it, yet"),
        ("info /ghost/odom", "Unknown topic '/ghost/odom'; robot ghost is not heard; heard here: bench"),
        ("find Odometri", "zteleop find: no topic here carries Odometri; known: "),
        ("node info actuatr", "zteleop node info: Unable to find node 'actuatr'; did you mean"),
        ("echo drive_status --field sate", "zteleop echo: Invalid field 'sate'"),
        (
            "echo drive_status --filter m.x.y==1",
            "zteleop echo: filter: Invalid field 'x.y': DriveStatus has no",
        ),
        ("echo drive_status Twist", "carries zteleop_msgs/msg/DriveStatus, not Twist"),
    ],
)
def test_what_is_not_there_is_said_with_what_may_have_been_meant(rig: Rig, line: str, words: str) -> None:
    said = ask(rig, line, code=1)
    assert words in said
    assert said.count("\n") == 1


def test_echo_shows_the_part_that_was_asked_for_so_often_as_was_asked(rig: Rig) -> None:
    said = ask(rig, "topic echo drive_status --field state --filter \"m.state == 'idle'\" --count 2")
    assert said == "idle\n---\n" * 2
    head, *rows = ask(
        rig, "echo drive_status --csv --header --field state --field why --count 2"
    ).splitlines()
    assert (head, rows) == ("state,why", ["idle,nobody drives"] * 2)


def test_types_are_told_as_ros_does_and_filled_in_for_pub(rig: Rig) -> None:
    assert "    geometry_msgs/msg/Twist\n" in rig.result("interface", "list").stdout
    service = rig.result("interface", "show", "std_srvs/srv/SetBool")
    assert (service.stdout, service.stderr) == ("bool data\n---\nbool success\nstring message\n", "")
    shown = rig.result("interface", "show", "geometry_msgs/msg/Twist").stdout
    assert "Vector3 linear\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\nVector3 angular\n" in shown
    proto = rig.result("interface", "proto", "Twist").stdout
    (values,) = shlex.split(proto)
    said = rig.result("pub", "chatter", "Twist", values, "--once", *rig.bus_options())
    assert "publishing #1: Twist(linear=Vector3(x=0.0" in said.stdout


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("interface show Twits", "zteleop interface show: no message type 'Twits'; did you mean"),
        ("interface list geometri_msgs", "no package 'geometri_msgs'; did you mean geometry_msgs"),
    ],
)
def test_a_type_that_is_none_is_answered_with_the_nearest(rig: Rig, line: str, words: str) -> None:
    result = rig.result(*line.split())
    assert (result.returncode, result.stdout) == (1, "")
    assert words in result.stderr


def test_pub_says_what_comes_on_its_input_and_tells_of_what_is_no_message(rig: Rig) -> None:
    echo = rig.join("echo", "chatter", "--field", "data", "--count", "3")
    until(lambda: "echo" in ask(rig, "info chatter -v"), "somebody who listens")
    command = [*ZTELEOP, "pub", "chatter", "String", "--stdin", *rig.bus_options()]
    said = '{"data": "one"}\n{"dota": 1}\ndata: two\n---\n---\ndata: three\n'
    result = subprocess.run(
        command,
        input=said,
        env=rig.environment,
        cwd=rig.folder,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert echo.ends() == 0
    assert echo.text.endswith("one\n---\ntwo\n---\nthree\n---")
    assert "String has no field 'dota'; did you mean data?" in result.stderr
    assert result.stderr.endswith("said 3\n")
    assert result.returncode == 0


def pipe(rig: Rig, line: str, said: str) -> subprocess.CompletedProcess[str]:
    """Run a verb with something on its standard input."""
    command = [*ZTELEOP, *shlex.split(line), *rig.bus_options()]
    where = {"env": rig.environment, "cwd": rig.folder}
    return subprocess.run(command, input=said, capture_output=True, text=True, timeout=PATIENCE, **where)


def test_a_motion_on_the_input_moves_and_fails_where_nothing_of_it_is_obeyed(rig: Rig) -> None:
    push = '{"linear": {"x": 0.5}}\n'
    with Watch(rig) as watch:
        result = pipe(rig, "pub cmd_vel Twist --stdin", push)
        assert result.returncode == 0, result
        assert any(ticks[1] > NEUTRAL[1] for ticks in watch.seen)
    ask(rig, "stop bench")
    try:
        result = pipe(rig, "pub cmd_vel Twist --stdin", push)
    finally:
        ask(rig, "stop bench --release")
    assert result.returncode == 1
    assert "nothing of it was obeyed: " in result.stderr
    result = pipe(rig, "pub controls Int16MultiArray --stdin", "data: [376]\n")
    assert "expected [steering, throttle], found [376]" in result.stderr


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ("{angular: {z: 1.0}}", "turns front wheels and moves nothing: a car turns only while it drives"),
        (
            "{linear: {x: 0.2}, angular: {z: 2.0}}",
            "more than the robot does: a circle of 0.10 m in radius, and 0.59 m is the tightest it drives",
        ),
    ],
)
def test_pub_says_what_a_car_does_not_make_of_a_turn(rig: Rig, values: str, words: str) -> None:
    pub = rig.join("pub", "cmd_vel", "Twist", values, "-r", "1")
    pub.says(words)
    until(lambda: "publishing #4" in pub.text, "some more")
    assert sum(word in pub.text for word in ("are asked for", "more than the robot does")) <= 1, "once"
    assert ("publish 10 times a second or more" in pub.text) is ("linear" in values)
    assert ("--rate 10 drives on" in pub.text) is ("linear" in values)
    ended(pub)


def test_a_command_that_commands_nothing_is_not_said(rig: Rig) -> None:
    error = ask(rig, "pub controls Int16MultiArray '{data: [376]}' -1", 1)
    assert error == "zteleop pub: expected [steering, throttle], found [376]\n"


def test_pub_that_goes_on_says_that_it_waits_no_longer(rig: Rig) -> None:
    pub = rig.join("pub", "cmdvel", "String", "-r", "10")
    until(lambda: "publishing #1" in pub.text, "a message")
    assert "waits no longer, and says it all the same" in ended(pub)


def test_a_motion_for_some_time_ends_with_neutral(rig: Rig) -> None:
    pub = rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 0.5}}", "-r", "20", "--for", "1s")
    until(lambda: rig.ticks[1] > NEUTRAL[1], "a robot that drives")
    assert pub.ends() == 0
    until(lambda: rig.ticks == NEUTRAL, "neutral")


def test_pub_may_wait_for_several_or_for_nobody(rig: Rig) -> None:
    assert "publishing #1" in ask(rig, "pub nowhere String --once -w 0")
    waits = rig.join("pub", "wide", "String", "--once", "-w", "2")
    waits.says("zteleop pub: waits for 2 who hear bench/wide: nobody hears it")
    ears = [rig.join("echo", "wide", "--once")]
    more = rig.join("pub", "wide", "String", "--once", "-w", "3")
    more.says("zteleop pub: waits for 3 who hear bench/wide: 1 of 3 so far, echo on ")
    more.signal(signal.SIGINT)
    ears.append(rig.join("echo", "wide", "--once"))
    assert [ear.ends() for ear in ears] == [0, 0]
    assert waits.ends() == 0


def test_log_shows_what_nodes_say_and_graph_who_says_what_to_whom(rig: Rig) -> None:
    log = rig.join("log", "--level", "warn")
    until(lambda: "Node name: log\n" in ask(rig, "info log -v"), "somebody who listens")
    node = rig.node("nose")
    # again and again, for what is said at once reaches nobody yet
    until(lambda: node.log.warn("it smells") or "[nose]: it smells" in log.text, "words")
    ended(log)
    assert re.search(r"^/bench/drive_status +actuator -> ", ask(rig, "graph"), re.MULTILINE)
    assert '  "/bench/actuator" -> "/bench/drive_status";' in ask(rig, "graph --dot").splitlines()


def test_a_list_is_complete_however_many_topics_there_are(rig: Rig) -> None:
    """Beyond 256 zenoh's own channel of replies is full, and whoever fills it is who should empty it."""
    session = rig.node("crowd").membership.session
    for number in range(600):
        session.declare_token(presence.endpoint_key(Name("bench", f"t{number}"), "pub", "crowd", (String,)))
    lines = ask(rig, "list").splitlines()
    assert {f"/bench/t{number}" for number in range(600)} <= set(lines)
