import json
import os
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.bus import codec
from zteleop.bus.tap import Raw
from zteleop.cli import blackbox as verb
from zteleop.cli import main
from zteleop.messages import DriveStatus, String
from zteleop.recording.blackbox_file import Header, Reason, utc, write

AT = 100.0
WHY = "keyboard has been silent for 0.3 s"


def raw(at: float, path: str, message: Any) -> Raw:
    return Raw(AT + at, path, codec.encoding_of(type(message)), codec.encode(message), b"", False)


def status(at: float, state: str, why: str) -> Raw:
    message = DriveStatus.zero()
    message.state, message.why = state, why  # type: ignore[assignment]
    return raw(at, "drive_status", message)


SAID = [
    status(-8.0, "driving", "keyboard drives"),
    raw(-1.0, "chatter", String("hello\x1b[2J\u202e")),
    status(0.0, "link lost", WHY),
    status(1.0, "idle", "nobody\x1b[31m\nx"),
]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def keep(
    home: Path, robot: str = "archangel", second: int = 0, said: list[Raw] = SAID, why: str = "link-lost"
) -> Path:
    trigger = Reason(AT, why, WHY)
    time = utc(1_700_000_000 + second)
    header = Header(1, robot, "1", AT, time, trigger.reason, WHY, 60.0, 14, [trigger])
    path = write(home / f"zteleop/robots/{robot}/blackbox", header, said)
    os.utime(path, (second, second))
    return path


def show(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[str]:
    assert main(["blackbox", *arguments]) == 0
    return capsys.readouterr().out.splitlines()


def fails(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["blackbox", *arguments]) == 1
    (words,) = capsys.readouterr().err.splitlines()
    return words


def test_the_newest_is_told_as_a_timeline(
    home: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    keep(home, second=0, said=[])
    path = keep(home, second=60)
    now = datetime.fromtimestamp(1_700_000_060 + 2 * 3600 + 3 * 60 + 5, UTC)
    monkeypatch.setattr(
        verb, "datetime", SimpleNamespace(now=lambda zone: now, fromisoformat=datetime.fromisoformat)
    )
    assert show(capsys) == [
        "black box of archangel: link lost, 2023-11-14 22:14:20 UTC, 60 s of 14 topics",
        "    -8.00 s  driving: keyboard drives",
        f"     0.00 s  link lost: {WHY}   <- written because of this",
        "    +1.00 s  idle: nobody\\u001b[31m\\u000ax",
        f"({path})",
        "(2 h 3 min 5 s old; the next comes 1 to 10 s late, and none from a robot that lost its power)",
    ]


def test_the_last_stop_is_named_where_something_came_after_it(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for second in (0, 60):
        stop = keep(home, second=second, why="stop")
    keep(home, "bert", 90, why="stop")
    assert not [line for line in show(capsys, "archangel") if "last stop" in line]
    keep(home, second=120)
    assert show(capsys, "archangel")[-1] == f"(the last stop: zteleop blackbox {stop})"


@pytest.mark.parametrize("arguments", [["anna"], ["--robot", "anna"]])
def test_a_robot_can_be_named(home: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]) -> None:
    keep(home, "anna", 0)
    keep(home, "bert", 60)
    assert show(capsys, *arguments)[0].startswith("black box of anna")
    assert show(capsys)[0].startswith("black box of bert")


def test_a_file_from_elsewhere_is_shown(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    keep(home).rename(home / "copied")
    assert show(capsys, "copied")[0].startswith("black box of archangel")
    assert show(capsys, str(home / "copied"))[-1].endswith("\\u000ax")


def test_a_folder_named_like_a_robot_is_not_meant(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    keep(home, "anna", 0)
    (home / "anna").mkdir(exist_ok=True)
    assert show(capsys, "anna")[0].startswith("black box of anna")


def test_every_message_can_be_a_line(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    keep(home)
    lines = show(capsys, "--all")
    assert len(lines) == 1 + len(SAID) + 2
    assert lines[2] == (
        "    -1.00 s  robot/archangel/chatter  application/json;std_msgs/msg/String"
        '  {"data":"hello\\u001b[2J\\u202e"}'
    )


def test_the_timeline_can_be_json(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    keep(home)
    lines = [json.loads(line) for line in show(capsys, "--json")]
    assert [(line["at"], line["reason"]) for line in lines] == [(-8.0, False), (0.0, True), (1.0, False)]


def test_files_are_listed_with_when_why_whose_and_how_large(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def size(path: Path) -> str:
        return f"{path.stat().st_size / 1000:.1f}"

    first, second = keep(home, "anna", 0), keep(home, "bert", 60)
    lines = show(capsys, "--list")
    assert [line.split() for line in lines] == [
        ["2023-11-14", "22:13:20", "UTC", "link-lost", "anna", size(first), "kB", str(first)],
        ["2023-11-14", "22:14:20", "UTC", "link-lost", "bert", size(second), "kB", str(second)],
    ]
    assert len(show(capsys, "--list", "anna")) == 1


def test_without_a_file_one_sentence_says_when_there_is_one(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "no robot of this machine has a black box" in fails(capsys)
    assert "no robot of this machine has a black box" in fails(capsys, "--list")
    keep(home)
    assert "nobody has no black box" in fails(capsys, "nobody")


@pytest.mark.parametrize("what", ["../..", "none.gz", "./none", "No Robot"])
def test_what_is_neither_a_robot_nor_a_file_is_one_sentence(
    home: Path, capsys: pytest.CaptureFixture[str], what: str
) -> None:
    assert fails(capsys, what).startswith("zteleop blackbox: ")


def test_of_a_torn_file_the_rest_is_shown_and_said(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = keep(home)
    path.write_bytes(path.read_bytes()[:-20])
    lines = show(capsys, str(path))
    assert lines[0].startswith("black box of archangel")
    assert lines[-1] == "not all of this file can be shown: its end is missing"
    assert main(["blackbox", "--json", str(path)]) == 0
    told = capsys.readouterr()
    assert [json.loads(line) for line in told.out.splitlines()]
    assert told.err == "not all of this file can be shown: its end is missing\n"


def test_a_robot_whose_name_was_mistyped_is_asked_about(
    home: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keep(home, "anna")
    assert fails(capsys, "ana").endswith("; did you mean anna?")


def test_a_demo_that_runs_has_its_files_in_a_folder_of_its_own(
    home: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(home))
    keep(home / "zteleop-demo-x1", "demo-1711")
    assert main(["blackbox", "demo-1711"]) == 0
    assert WHY in capsys.readouterr().out
    assert main(["blackbox"]) == 0
    assert main(["blackbox", "--list"]) == 0
    assert "demo-1711" in capsys.readouterr().out
