"""What is typed and what is answered: every verb as a process beside a running actuator."""

import json
import re
import shlex
import signal
import subprocess
import sys
import unicodedata
from collections.abc import Iterator
from pathlib import Path

import pytest
import zenoh
from rig import NEUTRAL, PATIENCE, Process, Rig, Watch, until

from zteleop.messages import MESSAGES

Result = subprocess.CompletedProcess
TOPICS = [
    "/bench/beat",
    "/bench/cmd_vel",
    "/bench/drive_status",
    "/bench/latency",
    "/bench/log",
    "/bench/pwm",
    "/bench/refusals",
    "/bench/stop",
    "/bench/vehicle",
    "/bench/watchdog",
    "/bench/why",
]
HOSTILE = "\x1b[2J\x1b]0;owned\x07\x9b31m\x7f\x85\r\u202e"


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("verbs")) as bench:
        bench.set("blackbox = false")  # it hears whoever publishes: nobody could be awaited by that
        bench.actuator()
        yield bench


@pytest.fixture(scope="module", autouse=True)
def lost(rig: Rig) -> Process:
    """A `pub` to a robot that is not there, begun early because it waits for one."""
    where = ("--no-multicast-scouting", "--connect", rig.endpoint)
    return rig.run("pub", "/ghost/cmd_vel", "Twist", "--once", *where)


@pytest.fixture(scope="module")
def stranger(rig: Rig) -> zenoh.Session:
    return rig.session()


def ask(rig: Rig, verb: str, *arguments: str) -> "Result[str]":
    return rig.result(verb, *arguments, *rig.bus_options())


def is_one_sentence(result: "Result[str]", verb: str, *words: str, code: int = 1) -> None:
    """Check that a verb failed in words a person can use."""
    assert result.returncode == code, result
    assert result.stdout == ""
    assert result.stderr.startswith(f"zteleop {verb}: "), result.stderr
    assert result.stderr.count("\n") == 1, result.stderr
    for word in words:
        assert word in result.stderr


def is_harmless(text: str) -> None:
    """Check that nothing printed can command a terminal or turn its text around."""
    found = {c for c in text if unicodedata.category(c) in ("Cc", "Cf") and c != "\n"}
    assert not found, f"{found} in {text!r}"


def said_by(rig: Rig, stranger: zenoh.Session, key: str, put: dict[str, object], *arguments: str) -> str:
    """Return what `echo` prints, and complains of, when somebody says something."""
    echo = rig.join("echo", *arguments)
    patient = zenoh.CongestionControl.BLOCK  # else what does not leave within a millisecond is dropped
    with stranger.declare_publisher(key, congestion_control=patient) as publisher:
        until(lambda: publisher.matching_status.matching, "somebody who listens")
        publisher.put(**put)
        echo.says("hostile")
    echo.signal(signal.SIGINT)
    assert echo.ends() == 130
    return echo.text


def test_list_is_complete_on_its_first_run(rig: Rig) -> None:
    result = ask(rig, "list")
    assert result.stdout.splitlines() == TOPICS
    assert (result.returncode, result.stderr) == (0, "")


def test_list_shows_types_and_who_is_there(rig: Rig) -> None:
    assert "/bench/beat [zteleop_msgs/msg/Beat]" in ask(rig, "list", "-t").stdout.splitlines()
    said, heard = ask(rig, "list", "-v").stdout.split("\n\n")
    assert said.startswith(
        "Published topics:\n * /bench/beat [zteleop_msgs/msg/Beat] 1 publisher\n     actuator on "
    )
    assert "\n * /bench/pwm [zteleop_msgs/msg/Pwm, std_msgs/msg/Int16MultiArray] 2 subscribers" in heard
    assert len(re.findall("actuator on .*: pwm/web", heard)) == 1, "not once for each type"
    assert re.search(r" subscribers, also controls\n     actuator on [-\w]+: pwm/\w+\n", heard)


def test_list_says_so_when_nobody_is_there(rig: Rig) -> None:
    result = rig.result("list", "--robot", "nobody", "--no-multicast-scouting", "-e", rig.endpoint)
    assert result.returncode == 1
    assert "nobody speaks for nobody; heard here: bench" in result.stdout + result.stderr


def test_list_survives_names_that_are_none(rig: Rig, stranger: zenoh.Session) -> None:
    keys = (f"robot/bench/live/pub/{HOSTILE}/x-1/any/x", "robot/bench/live/pub/short", "robot/bench/live/pub")
    tokens = [stranger.liveliness().declare_token(key) for key in keys]
    result = ask(rig, "list", "-t", "-v")
    for token in tokens:
        token.undeclare()
    assert (result.returncode, result.stderr) == (0, "")
    assert set(TOPICS) <= set(re.findall(r"^ \* (\S+)", result.stdout, re.MULTILINE))
    is_harmless(result.stdout)


def test_echo_prints_a_message_and_ends(rig: Rig) -> None:
    result = ask(rig, "echo", "/bench/drive_status", "--once")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.startswith("state: idle\nwhy: ")
    assert result.stdout.endswith("\n---\n")
    assert result.stdout.count("---") == 1


def test_echo_says_where_there_is_no_history_and_goes_on(rig: Rig) -> None:
    for since, words in (("30s", "nobody serves /bench/blackbox/history"), ("90s", "a black box keeps 60 s")):
        result = ask(rig, "echo", "drive_status", "--since", since, "--once")
        assert result.stderr.startswith(f"zteleop echo: no history: {words}")
        assert result.stdout.startswith("state: idle")


def test_echo_prints_json_a_line(rig: Rig) -> None:
    (line,) = ask(rig, "echo", "drive_status", "--once", "--json").stdout.splitlines()
    status = json.loads(line)
    assert status["state"] == "idle"
    assert [pulse["duty_ticks"] for pulse in status["pulses"]] == [370, 375]


def test_echo_finds_the_only_robot_there_is(rig: Rig) -> None:
    result = rig.result("echo", "beat", "--once", "--json", "--no-multicast-scouting", "-e", rig.endpoint)
    assert json.loads(result.stdout)["epoch"] > 0


def test_a_client_says_soon_for_which_router_it_waits(rig: Rig) -> None:
    process = rig.run("list", "-m", "client", "-e", "tcp/127.0.0.1:9", "--no-multicast-scouting")
    assert process.ends() == 1
    waits, ends = process.text.splitlines()
    assert waits == "waits for a router, tcp/127.0.0.1:9"
    assert ends.startswith("zteleop list: no router found (tcp/127.0.0.1:9)")


def test_echo_says_once_what_it_waited_for_in_vain(rig: Rig) -> None:
    waits, ends = ask(rig, "echo", "battery_state", "--timeout", "1.5").stderr.splitlines()
    assert waits.startswith("zteleop echo: waits for bench/battery_state: nobody publishes it")
    assert ends == "zteleop echo: for 1.5 s nothing was said on bench/battery_state"


def test_echo_gives_up_after_its_timeout(rig: Rig) -> None:
    result = ask(rig, "echo", "battery_state", "--timeout", "0.1")
    is_one_sentence(result, "echo", "for 0.1 s nothing was said on bench/battery_state: nobody publishes it")


@pytest.mark.parametrize(
    ("topic", "words"),
    [
        ("bench/odmo", "bench/odmo: nobody publishes it; did you mean odom?"),
        ("bench/odom", "bench/odom: nobody publishes it now"),
        ("/bensh/odom", "bensh/odom: nobody publishes it; robot bensh is not heard; heard here: bench"),
    ],
)
def test_echo_says_once_for_whom_it_waits_and_waits_on(
    rig: Rig, stranger: zenoh.Session, topic: str, words: str
) -> None:
    echo = rig.run("echo", topic, "--no-multicast-scouting", "-e", rig.endpoint)
    echo.says(f"zteleop echo: waits for {words}")
    patient = zenoh.CongestionControl.BLOCK  # else what does not leave within a millisecond is dropped
    key = f"robot/{topic.strip('/')}"
    with stranger.declare_publisher(key, congestion_control=patient) as publisher:
        until(lambda: publisher.matching_status.matching, "somebody who listens")
        publisher.put('{"data": "at last"}', encoding="application/json")
        echo.says("data: at last")
    assert echo.text.count("waits for") == 1
    echo.signal(signal.SIGINT)
    assert echo.ends() == 130


def test_pub_says_who_hears(rig: Rig) -> None:
    echo = rig.join("echo", "soil")
    echo.says("waits for bench/soil")
    result = ask(rig, "pub", "soil", "String", "{data: dry}", "--once")
    assert result.returncode == 0
    assert re.fullmatch(r"zteleop pub: echo on \S+ hears it\n", result.stderr)
    echo.signal(signal.SIGINT)
    assert echo.ends() == 130


def test_pub_fails_where_nobody_hears_and_says_what_was_meant(rig: Rig) -> None:
    result = ask(rig, "pub", "cmdvel", "Twist", "{linear: {x: 0.2}}", "--once")
    assert result.returncode == 1
    assert result.stderr.splitlines() == [
        "zteleop pub: waits for who hears bench/cmdvel: nobody hears it; did you mean cmd_vel?",
        "zteleop pub: said to nobody: nobody hears it; did you mean cmd_vel?",
    ]


def test_a_second_simulation_of_a_robot_is_refused(rig: Rig) -> None:
    first = rig.join("sim")
    first.says("sim: info: moves bench, a simulated car, by the pulses in ")
    rig.join("echo", "odom").says("child_frame_id: base_link")
    is_one_sentence(
        ask(rig, "sim"), "sim", "robot bench is simulated already, by ", "end that, or say --robot"
    )
    first.signal(signal.SIGINT)
    assert first.ends() == 130


def test_a_simulation_of_another_vehicle_than_is_driven_is_said_to_be_one(rig: Rig) -> None:
    tank = rig.join("sim", "tank")
    tank.says("moves bench, a simulated tank, by the pulses in ")
    tank.says("its pulses mean something else: that one steers, and this one turns by its wheels")
    tank.signal(signal.SIGINT)
    assert tank.ends() == 130


def test_a_simulation_says_that_nobody_moves_it(rig: Rig) -> None:
    sim = rig.run("sim", "--robot", "lonely", "--no-multicast-scouting", "-e", rig.endpoint)
    sim.says("waits for pulses: no actuator of lonely is heard (heard here: bench); start zteleop actuator")


def test_echo_prints_a_type_that_nobody_knows(rig: Rig, stranger: zenoh.Session) -> None:
    put = {"payload": '{"hostile": [1, null]}', "encoding": "application/json;acme_msgs/msg/Soil"}
    text = said_by(rig, stranger, "robot/bench/soil", put, "soil", "--json")
    assert text == '{"hostile":[1,null]}'


@pytest.mark.parametrize("form", [[], ["--json"]], ids=["yaml", "json"])
def test_echo_never_lets_a_message_command_the_terminal(
    rig: Rig, stranger: zenoh.Session, form: list[str]
) -> None:
    payload = json.dumps({HOSTILE: f"hostile{HOSTILE}"}, ensure_ascii=False)
    put = {"payload": payload, "encoding": f"application/json;x/msg/{HOSTILE}"}
    is_harmless(said_by(rig, stranger, "robot/bench/note", put, "note", *form))


def test_echo_never_lets_a_complaint_command_the_terminal(rig: Rig, stranger: zenoh.Session) -> None:
    put = {"payload": b"\xff\x1b[2J", "encoding": f"hostile{HOSTILE}"}
    is_harmless(said_by(rig, stranger, f"robot/bench/cmd_vel/{HOSTILE}", put, "cmd_vel"))


def test_a_broken_pipe_ends_echo_quietly(rig: Rig) -> None:
    words = [sys.executable, "-m", "zteleop", "echo", "beat", "--json", *rig.bus_options()]
    pipe = f"{shlex.join(words)} | head -1; echo ${{PIPESTATUS[0]}}"
    result = subprocess.run(
        ["bash", "-c", pipe], env=rig.environment, capture_output=True, text=True, timeout=PATIENCE
    )
    assert result.stderr == ""
    beat, code = result.stdout.splitlines()
    assert json.loads(beat)["time"] > 0
    assert code == "1"


@pytest.mark.parametrize(
    ("number", "topic", "kind", "values"),
    [
        (signal.SIGINT, "cmd_vel", "Twist", "{linear: {x: 0.5}}"),
        (signal.SIGTERM, "cmd_vel", "TwistStamped", "{twist: {linear: {x: 0.5}}}"),
        (signal.SIGINT, "pwm", "Pwm", "{steering_ticks: 375, throttle_ticks: 380}"),
        (signal.SIGTERM, "controls", "Int16MultiArray", "{data: [375, 380]}"),
    ],
)
def test_a_repeated_pub_ends_with_neutral(rig: Rig, number: int, topic: str, kind: str, values: str) -> None:
    pub = rig.join("pub", topic, kind, values, "-r", "20")
    with Watch(rig) as watch:
        until(lambda: rig.ticks[1] > NEUTRAL[1] + 5, "motion")
        pub.signal(number)
        until(lambda: rig.ticks == NEUTRAL, "neutral")
        assert pub.ends() == 128 + number
    assert rig.ticks == NEUTRAL
    assert min(throttle for _, throttle in watch.seen) == NEUTRAL[1], "it went back and forth"
    assert "Traceback" not in pub.text


def test_pub_says_it_so_many_times(rig: Rig) -> None:
    echo = rig.join("echo", "note")
    result = ask(rig, "pub", "note", "std_msgs/msg/String", "{data: hello}", "-t", "3", "-r", "100")
    assert result.returncode == 0
    assert result.stdout.count("data='hello'") == 3
    echo.says("data: hello")


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        ("Twits", "{}", ["no message type 'Twits'", "did you mean geometry_msgs/msg/Twist"]),
        ("Twist", "{linear: {x: 1", ["expected YAML such as"]),
        ("Twist", "{linaer: {x: 1}}", ["Twist has no field 'linaer'", "did you mean linear?"]),
        ("Twist", "{linear: {x: fast}}", ["Expected `float`, got `str`", "$.linear.x"]),
        ("Twist", "{linear: {x: .nan}}", ["expected a finite number, found nan", "Twist.linear.x"]),
        ("Pwm", "{steering_ticks: 99999}", ["$.steering_ticks"]),
        ("Twist", "[1, 2]", ["expected {linear, angular}", "found [1, 2]"]),
        ("Odometry", "{}", ["takes TwistStamped or Twist, found Odometry"]),
    ],
)
def test_pub_refuses_what_it_cannot_say_in_one_sentence(
    rig: Rig, kind: str, values: str, words: list[str]
) -> None:
    topic = "pwm" if kind == "Pwm" else "cmd_vel"
    with Watch(rig) as watch:
        result = ask(rig, "pub", topic, kind, values, "--once")
    assert watch.seen == {NEUTRAL}
    result.stdout = result.stdout.replace("publishing #1", "")
    assert result.returncode == 1
    assert result.stderr.startswith("zteleop pub: ")
    assert result.stderr.count("\n") == 1
    for word in words:
        assert word in result.stderr


def test_debug_shows_the_traceback(rig: Rig) -> None:
    result = ask(rig, "pub", "cmd_vel", "Twits", "--debug")
    assert result.returncode == 1
    assert "Traceback (most recent call last)" in result.stderr
    assert "MessageError: no message type 'Twits'" in result.stderr


@pytest.mark.parametrize(("verb", "word"), [("ecko", "did you mean echo?"), ("fly", "known: demo, keyboard")])
def test_an_unknown_verb_is_told_the_nearest(rig: Rig, verb: str, word: str) -> None:
    result = rig.result(verb)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == f"zteleop: no verb '{verb}'; {result.stderr.partition('; ')[2]}"
    assert word in result.stderr


@pytest.mark.parametrize(
    ("verb", "name"),
    [
        ("list", "Bench"),
        ("echo", "a/b"),
        ("pub", "**"),
        ("actuator", ""),
        ("keyboard", "-bench"),
        ("sim", "b" * 64),
    ],
)
def test_a_name_that_is_none_is_refused(rig: Rig, verb: str, name: str) -> None:
    result = rig.result(verb, f"--robot={name}", *{"echo": ["beat"], "pub": ["note", "String"]}.get(verb, []))
    assert result.returncode == 2
    assert "a robot's name is 1 to 63 of a-z, 0-9, _ and -" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("topic", ["/bench/*", "bench/cmd vel", "/**/beat", ""])
def test_a_topic_that_is_none_is_refused(rig: Rig, topic: str) -> None:
    result = ask(rig, "echo", topic, "--timeout", "1")
    is_one_sentence(result, "echo", "found")


@pytest.mark.parametrize("endpoint", ["nonsense", "tcp/127.0.0.1"])
def test_an_endpoint_that_is_none_is_refused(rig: Rig, endpoint: str) -> None:
    result = rig.result("list", "--no-multicast-scouting", "-e", endpoint)
    is_one_sentence(result, "list", endpoint.partition("/")[0])


def test_a_client_without_a_router_says_so(rig: Rig, tmp_path: Path) -> None:
    config = tmp_path / "impatient.toml"
    config.write_text("[bus]\npatience = 0.2\n")
    result = rig.result(
        "list", "--config", str(config), "-m", "client", "--no-multicast-scouting", "-e", "tcp/127.0.0.1:9"
    )
    is_one_sentence(result, "list", "no router found (tcp/127.0.0.1:9)", "is the robot on")


def test_a_machine_without_i2c_is_told_the_next_step(rig: Rig) -> None:
    result = rig.result("actuator", "--driver", "pca9685", "--robot", "other", "--no-multicast-scouting")
    is_one_sentence(result, "actuator", "/dev/i2c-1 not found", "raspi-config nonint do_i2c 0")


def test_schema_writes_a_schema_for_every_message_and_for_the_settings(rig: Rig, tmp_path: Path) -> None:
    result = rig.result("schema", str(tmp_path / "schemas"))
    assert (result.returncode, result.stderr) == (0, "")
    files = {str(p.relative_to(tmp_path / "schemas")): p for p in tmp_path.rglob("*.json")}
    assert files.keys() == {f"{name}.json" for name in MESSAGES} | {"config.json"}
    for name, file in files.items():
        schema = json.loads(file.read_text())
        assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
        assert schema["title"] == ("config.toml" if name == "config.json" else name.removesuffix(".json"))


def test_check_says_what_a_good_file_makes(rig: Rig, tmp_path: Path) -> None:
    config = tmp_path / "config.toml"
    config.write_text('robot = "archangel"\n[drive.limits]\nspeed = 1.5\n')
    result = rig.result("check", str(config))
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.startswith(f"{config}: good\nrobot    archangel\n")
    assert "at most 1.5 m/s" in result.stdout
    assert result.stdout.splitlines()[-2:] == [
        "set      drive.limits.speed = 1.5",
        "set      robot = archangel",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("robot = 'Arch Angel'", [":1:1: robot: a robot's name is", "'Arch Angel'"]),
        ("[drive.limits]\nspeeed = 1", [":2:1: drive.limits.speeed: no such setting; did you mean speed?"]),
        ("driver = 'pca9865'", [":1:1: driver: no driver named 'pca9865'; did you mean pca9685?"]),
        ("[drive\n", [":1:7: not TOML"]),
        ("[drive.servos.steering]\nchannel = 99", [":2:1: drive.servos.steering.channel: ", "found 99"]),
    ],
)
def test_check_says_where_a_bad_file_is_wrong(rig: Rig, tmp_path: Path, text: str, words: list[str]) -> None:
    config = tmp_path / "config.toml"
    config.write_text(text)
    is_one_sentence(rig.result("check", str(config)), "check", str(config), *words)


def test_check_says_all_that_is_wrong_and_a_stop_goes_on(rig: Rig, tmp_path: Path) -> None:
    config = tmp_path / "config.toml"
    config.write_text("[drive.limits]\nspeeed = 1\nturn = 'fast'\n[speeds]\nforward = -1\n")
    checked = rig.result("check", str(config))
    assert (checked.returncode, checked.stdout) == (1, "")
    assert [line.split(": ")[1] for line in checked.stderr.splitlines()[1:]] == [
        "drive.limits.turn",
        "speeds.forward",
    ]
    stopped = ask(rig, "stop", "--release", "--config", str(config))
    assert "drive.limits.speeed: no such setting; did you mean speed? (and 2 more" in stopped.stderr
    assert stopped.stderr.count("\n") == 1


def test_check_says_when_there_is_no_file(rig: Rig) -> None:
    is_one_sentence(rig.result("check", "nowhere.toml"), "check", "cannot read nowhere.toml", "No such file")


def test_pub_says_when_no_robot_answers(lost: Process) -> None:
    assert lost.ends() == 1
    assert lost.text == (
        "zteleop pub: waits for ghost; heard here: bench\n"
        "zteleop pub: robot ghost does not answer; is its actuator on? heard here: bench"
    )
