"""What `chaos` says and refuses before it does anything; what it does is tests/faults."""

import io
import sys
from pathlib import Path

import pytest

from zteleop.cli import main


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for kind in ("CONFIG", "STATE"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", str(tmp_path))


def test_list_does_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--list", "--only", "stop"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "people: several people, or one who does the wrong thing"
    assert "  stop pressed" in lines
    assert all("stop" in line for line in lines if line.startswith(" "))


def test_an_unknown_fault(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--only", "earthquake"]) == 1
    assert capsys.readouterr().err == (
        "zteleop chaos: no fault is called 'earthquake'; zteleop chaos --list shows them\n"
    )


def test_a_real_robot_needs_a_real_chip(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chaos", "--real"]) == 1
    assert "the simulated one is configured; set driver" in capsys.readouterr().err


def test_a_stop_in_force_is_heeded_and_nothing_is_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("config.toml").write_text('robot = "archangel"\ndriver = "pca9685"\n')
    place = tmp_path / "zteleop" / "robots" / "archangel"
    place.mkdir(parents=True)
    (place / "stop").write_text("")
    assert main(["chaos", "--real"]) == 1
    assert capsys.readouterr().err == (
        "zteleop chaos: archangel is stopped; zteleop stop --release archangel first\n"
    )


def test_what_needs_a_simulated_chip_is_not_certified_on_a_real_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("config.toml").write_text('driver = "pca9685"\n')
    assert main(["chaos", "--real", "--only", "chip:"]) == 1
    assert "each of them needs a simulated chip" in capsys.readouterr().err


def test_nothing_turns_before_somebody_typed_so(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("config.toml").write_text('driver = "pca9685"\n')
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    assert main(["chaos", "--real"]) == 1
    said = capsys.readouterr()
    assert "Lift its wheels off the ground" in said.err
    assert said.err.endswith("nothing was done: expected the words 'wheels up'\n")
    assert said.out == ""
