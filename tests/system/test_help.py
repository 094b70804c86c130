"""What the help of each verb ends with works when it is pasted; only where the bus is, is added."""

import re
import shlex
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import pytest
from rig import Process, Rig, until

from zteleop.cli import GROUPS, VERBS, file_of, find_verb

DOCS = Path(__file__).parents[2] / "docs"
EXAMPLES = [(verb, text) for verb in VERBS for text in import_module(f"zteleop.cli.{file_of(verb)}").EXAMPLES]
TYPED = re.findall(r"\| `zteleop ([^`]+)` \|", (DOCS / "shell.md").read_text())
"""what the table for those who know ROS says in its last column"""
EXAMPLES += [(find_verb(shlex.split(text))[0], f"zteleop {text}") for text in TYPED]
OF_ACTUATOR = "/archangel/actuator:\n  ros__parameters:\n    limits.speed: 0.5\n"
ON_A_SCREEN = {"demo": "quit", "keyboard": "quit", "gamepad": "quit", "keys": "Ctrl-C ends"}
ALONE = {"actuator", "chaos", "check", "demo", "init", "keys", "neutral", "run", "schema", "up"}
ALONE |= {f"interface {word}" for word in GROUPS["interface"]} | {"completion"}
"""verbs that need no robot that is there already, or no bus"""


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("archangel"), "archangel") as bench:
        bench.set('robot = "archangel"')
        bench.actuator()
        yield bench


@pytest.fixture
def nobody(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("nobody")) as bench:
        bench.set('[launch]\nrobot = "actuator --no-multicast-scouting"\n')
        yield bench


def goes_on(verb: str, words: list[str]) -> bool:
    """Say whether a command ends only when it is told to."""
    if verb in ("echo", "pub", "watchdog", "latency"):
        return not {"--once", "--times", "--count", "-t", "--for"} & set(words)
    endless = ("actuator", "buttons", "sim", "odometry", "camera", "hz", "bw", "delay", "watch", "log", "web")
    return verb in endless or words == ["up"]


def says_something_and_ends(process: Process) -> None:
    until(lambda: process.lines, "a line")
    process.signal(signal.SIGINT)
    assert process.ends() == 130, process.text


def needs_odometry(text: str) -> bool:
    verb = find_verb(text.split()[1:])[0]
    return verb in ("circle", "square", "goto") or ("odom" in text.lower() and verb != "odometry")


@contextmanager
def odometry(rig: Rig, text: str) -> Iterator[None]:
    """Let a simulated car say where it is, where that is asked for."""
    sim = rig.join("sim") if needs_odometry(text) else None
    where = ("--no-multicast-scouting", "--connect", rig.endpoint)
    until(lambda: not sim or rig.result("type", "archangel/odom", *where).returncode == 0, "odometry")
    yield
    if sim:
        says_something_and_ends(sim)


@pytest.mark.parametrize(("verb", "text"), EXAMPLES, ids=[text[:60] for _, text in EXAMPLES])
def test_an_example_works(rig: Rig, nobody: Rig, verb: str, text: str) -> None:
    name, *words = shlex.split(text)
    assert (name, find_verb(words)[0]) == ("zteleop", verb)
    words = words[: words.index(">")] if ">" in words else words
    if verb == "blackbox":  # the stop that comes before has left one behind
        until(lambda: rig.result("blackbox", "--list").stdout, "a black box's file")
    elif verb not in ALONE:
        words += ["--no-multicast-scouting", "--connect", rig.endpoint]
    place = nobody if verb in ALONE else rig
    if verb == "run":
        (place.folder / words[1]).parent.mkdir(exist_ok=True)
        (place.folder / words[1]).write_text("import zteleop; print(zteleop.Twist.planar(0.1))")
    if verb == "param load":
        (place.folder / words[3]).write_text("/**:\n  ros__parameters:\n    log_level: info\n" + OF_ACTUATOR)
    if verb in ON_A_SCREEN:
        terminal = place.terminal(*words)
        terminal.shows(ON_A_SCREEN[verb])
        terminal.type("\x03" if verb == "keys" else "q")
        assert terminal.ends() == 0
        terminal.is_as_found()
    elif goes_on(verb, words):
        with odometry(rig, text):
            says_something_and_ends(
                place.run(*words, *(["--no-multicast-scouting"] if verb == "actuator" else []))
            )
    elif needs_odometry(text):
        with odometry(rig, text):
            result = place.result(*words)
            assert result.returncode == 0, result.stderr
            assert result.stdout
    else:
        result = place.result(*words)
        assert (result.returncode, result.stderr) == (0, ""), result.stderr
        assert result.stdout


def test_the_help_ends_with_two_examples(rig: Rig) -> None:
    for verb in ("hz", "stop"):
        lines = rig.result(verb, "--help").stdout.splitlines()
        assert lines[-3] == "examples:"
        assert [line.split()[:2] for line in lines[-2:]] == [["zteleop", verb]] * 2
