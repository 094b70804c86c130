"""What `chaos` says and refuses before it does anything; what it does is tests/faults."""

import io
import sys

import pytest

from zteleop.cli import main


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(str(tmp_path))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))


def test_list_does_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--list", "--only", "stop"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "people     stop pressed" in lines
    assert all("stop" in line for line in lines)


def test_an_unknown_fault(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--only", "earthquake"]) == 1
    assert capsys.readouterr().err == (
        "zteleop chaos: no fault is called 'earthquake'; zteleop chaos --list shows them\n"
    )


def test_a_real_robot_needs_a_real_chip(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--real"]) == 1
    assert "the simulated one is configured; set driver" in capsys.readouterr().err


def test_nothing_turns_before_somebody_typed_so(
    tmp_path: object, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with open("config.toml", "w") as file:
        file.write('driver = "pca9685"\n')
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    assert main(["chaos", "--real"]) == 1
    said = capsys.readouterr()
    assert "Lift them off the ground" in said.err
    assert said.err.endswith("nothing was done: expected the words 'wheels up'\n")
    assert said.out == ""
