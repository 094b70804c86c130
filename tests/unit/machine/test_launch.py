"""Programs that are started together: real processes, whose lines are awaited."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable

import pytest

from zteleop.machine import launch
from zteleop.machine.launch import Launch, Program

Lines = list[tuple[str, str]]


def python(text: str, ends_first: bool = False) -> Program:
    return Program([sys.executable, "-u", "-c", text], ends_first)


STAYS = """
import signal, sys, time
signal.signal(signal.SIGTERM, lambda *_: sys.exit(print("ends")))
print("stays")
while True: time.sleep(1)
"""


class Enough(Exception):  # noqa: N818  what a test ends a launch by
    pass


def run_until(enough: Callable[[Lines], object], **programs: Program) -> Lines:
    """Run programs until their lines are what a test waits for; return all lines."""
    lines: Lines = []
    ended = False

    def tell(name: str, line: str) -> None:
        nonlocal ended
        lines.append((name, line))
        if not ended and enough(lines):
            ended = True
            raise Enough

    with pytest.raises(Enough):
        Launch(programs, tell).run()
    return lines


def test_when_all_are_done_so_is_it() -> None:
    lines: Lines = []
    code = Launch(
        {"a": python("print('one\\ntwo')"), "b": python("import sys; sys.stderr.write('no end')")},
        lambda *line: lines.append(line),
    ).run()
    assert code == 0
    assert [line for line in lines if line[0] == "a"] == [("a", "one"), ("a", "two"), ("a", "is done")]
    assert [line for line in lines if line[0] == "b"] == [("b", "no end"), ("b", "is done")]


def test_what_fails_is_started_again_and_later_each_time() -> None:
    lines = run_until(lambda lines: len(lines) == 4, a=python("print('here'); raise SystemExit(3)"))
    said = [line for _, line in lines]
    assert said[:4] == [
        "here",
        "ended with exit code 3; starts again in 0.1 s",
        "here",
        "ended with exit code 3; starts again in 0.2 s",
    ]


@pytest.mark.parametrize(
    ("program", "code", "words"),
    [
        (
            python("raise SystemExit(2)"),
            2,
            "ended with exit code 2: it was called wrongly, or is not there; it is not started again",
        ),
        (Program(["/no/such/program"]), 127, "cannot be started: No such file or directory"),
    ],
)
def test_what_no_second_start_mends_is_not_started_again(program: Program, code: int, words: str) -> None:
    lines: Lines = []
    launched = Launch({"bad": program, "good": python("pass")}, lambda *line: lines.append(line))
    assert launched.run() == code
    assert ("bad", words) in lines
    assert ("good", "is done") in lines


def test_what_moves_something_has_ended_before_the_others_are_told_to() -> None:
    both = {"world": python(STAYS), "wheels": python(STAYS, ends_first=True), "last": python(STAYS)}
    lines = run_until(lambda lines: len(lines) == 3, **both)
    assert [name for name, line in lines if line == "ends"] == ["wheels", "last", "world"]


def test_what_does_not_end_is_killed_with_its_children(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launch, "ENDS_WITHIN", 0.2)
    stubborn = python(
        "import os, signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); child = os.fork()\n"
        "if child: print(child)\nwhile True: time.sleep(1)"
    )
    lines = run_until(lambda lines: len(lines) == 1, a=stubborn)
    child = int(lines[0][1])
    assert lines[1] == ("a", "did not end within 0.2 s, and is killed")
    give_up = time.monotonic() + 10
    while os.path.exists(f"/proc/{child}") and time.monotonic() < give_up:
        with open(f"/proc/{child}/stat") as stat:
            if stat.read().rpartition(")")[2].split()[0] == "Z":
                break
        time.sleep(0.01)
    else:
        assert not os.path.exists(f"/proc/{child}")


def test_whoever_listened_may_go_and_all_of_them_end() -> None:
    launched: list[int] = []

    def tell(name: str, line: str) -> None:
        launched.append(1)
        raise BrokenPipeError

    with pytest.raises(BrokenPipeError):
        Launch({"a": python(STAYS), "b": python(STAYS)}, tell).run()
    assert len(launched) >= 1


def test_a_line_without_an_end_is_told_in_pieces() -> None:
    lines = run_until(
        lambda lines: len(lines) == 3, a=python("import sys\nwhile True: sys.stdout.write('x' * 9999)")
    )
    assert all(len(line) < 2 * launch.AT_ONCE for _, line in lines)


def test_no_key_of_a_terminal_reaches_them_and_their_input_ends_with_us() -> None:
    text = (
        "import os, sys; print(os.getsid(0) == os.getpid(), os.isatty(0)); sys.stdin.read(); print('ended')"
    )
    lines = run_until(lambda lines: len(lines) == 1, a=python(text + "\nimport time; time.sleep(60)"))
    assert lines[0] == ("a", "True False")


def test_it_is_ended_by_a_signal_as_any_verb() -> None:
    lines: Lines = []
    main = threading.main_thread().ident

    def tell(name: str, line: str) -> None:
        lines.append((name, line))
        if line == "stays":
            assert main
            signal.pthread_kill(main, signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        Launch({"a": python(STAYS)}, tell).run()
    assert lines == [("a", "stays"), ("a", "ends")]
