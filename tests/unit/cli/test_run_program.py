import os
import sys
from pathlib import Path

import pytest

from zteleop.cli._run import run_verb


@pytest.fixture
def become(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[list[str]]:
    """What the process became."""
    monkeypatch.chdir(tmp_path)
    became: list[list[str]] = []
    monkeypatch.setattr(os, "execv", lambda path, words: became.append([path, *words]))
    return became


def test_a_program_is_told_everything_behind_its_name(become: list[list[str]]) -> None:
    Path("follow.py").touch()
    assert run_verb("run", "run", ["follow.py", "archangel", "--debug", "-x", "--", "-y"]) == 0
    words = ["follow.py", "archangel", "--debug", "-x", "--", "-y"]
    assert become == [[sys.executable, sys.executable, *words]]


@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("folow.py", "there is no file folow.py; did you mean follow.py?"),
        ("code/folow.py", "there is no file code/folow.py; there is no Python program in "),
        ("keyboard", "keyboard is a verb of zteleop: say zteleop keyboard"),
        (".", "expected a Python program, found the folder ."),
    ],
)
def test_what_is_no_program_is_said(
    become: list[list[str]], capsys: pytest.CaptureFixture[str], file: str, words: str
) -> None:
    Path("follow.py").touch()
    assert run_verb("run", "run", [file]) == 1
    assert capsys.readouterr().err.startswith(f"zteleop run: {words}")
    assert become == []
