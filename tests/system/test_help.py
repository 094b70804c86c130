"""What the help of each verb ends with works when it is pasted; only where the bus is, is added."""

import shlex
import signal
from collections.abc import Iterator
from importlib import import_module

import pytest
from rig import Process, Rig, until

from zteleop.cli import VERBS

EXAMPLES = [(verb, text) for verb in VERBS for text in import_module(f"zteleop.cli.{verb}").EXAMPLES]
ON_A_SCREEN = {"demo": "quit", "keyboard": "quit"}
ALONE = {"actuator", "chaos", "check", "demo", "neutral", "schema"}
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
        yield bench


def goes_on(verb: str, words: list[str]) -> bool:
    """Say whether a command ends only when it is told to."""
    if verb in ("echo", "pub", "watchdog"):
        return not {"--once", "--times"} & set(words)
    return verb in ("actuator", "sim")


def says_something_and_ends(process: Process) -> None:
    until(lambda: process.lines, "a line")
    process.signal(signal.SIGINT)
    assert process.ends() == 130, process.text


@pytest.mark.parametrize(("verb", "text"), EXAMPLES, ids=[text[:60] for _, text in EXAMPLES])
def test_an_example_works(rig: Rig, nobody: Rig, verb: str, text: str) -> None:
    name, *words = shlex.split(text)
    assert (name, words[0]) == ("zteleop", verb)
    if verb == "blackbox":  # the stop that comes before has left one behind
        until(lambda: rig.result("blackbox", "--list").stdout, "a black box's file")
    elif verb not in ALONE:
        words += ["--no-multicast-scouting", "--connect", rig.endpoint]
    place = nobody if verb in ALONE else rig
    if verb in ON_A_SCREEN:
        terminal = place.terminal(*words)
        terminal.shows(ON_A_SCREEN[verb])
        terminal.type("q")
        assert terminal.ends() == 0
        terminal.is_as_found()
    elif goes_on(verb, words):
        sim = rig.join("sim") if verb == "echo" else None
        says_something_and_ends(
            place.run(*words, *(["--no-multicast-scouting"] if verb == "actuator" else []))
        )
        if sim:
            says_something_and_ends(sim)
    else:
        result = place.result(*words)
        assert (result.returncode, result.stderr) == (0, ""), result.stderr
        assert result.stdout


def test_the_help_ends_with_two_examples(rig: Rig) -> None:
    for verb in ("echo", "stop"):
        lines = rig.result(verb, "--help").stdout.splitlines()
        assert lines[-3] == "examples:"
        assert [line.split()[:2] for line in lines[-2:]] == [["zteleop", verb]] * 2
