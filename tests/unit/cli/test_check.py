from pathlib import Path

import pytest

from zteleop.cli._run import run_verb

ROOT = Path(__file__).parents[3]


@pytest.fixture(autouse=True)
def nowhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "none"))
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("arguments", [[str(ROOT / "config.toml")], ["--config", str(ROOT / "config.toml")]])
def test_a_good_file_is_told_with_what_it_makes(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_verb("check", "check", arguments) == 0
    out = capsys.readouterr().out
    assert out.startswith(f"{ROOT / 'config.toml'}: good\n")
    assert "vehicle  ackermann, at most 3 m/s and 5.1 rad/s\n" in out
    assert "steering channel 1: 1183 1530 1877 us = 290 375 460 ticks\n" in out
    assert "throttle channel 0: 898 1510 2040 us = 220 370 500 ticks\n" in out
    assert out.endswith("sources  web 100, gamepad 95, keyboard 90, buttons 80, program 50, planner 10\n"), (
        "nothing is set anew"
    )


def test_pulses_that_fit_no_period_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.toml").write_text("[drivers.simulated]\nfrequency_hz = 600\n")
    assert run_verb("check", "check", []) == 1
    assert capsys.readouterr().err == (
        "zteleop check: drive.servos.throttle: its longest pulse, 2040 us, does not fit a period of 1638 us; "
        "lower the driver's frequency_hz\n"
    )


def test_a_limit_that_bounds_nothing_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.toml").write_text("[drive.limits]\nspeed = 7\nturn = 1.0\n")
    assert run_verb("check", "check", []) == 0
    notes = [line for line in capsys.readouterr().out.splitlines() if line.startswith("note")]
    assert notes == ["note     limits.speed = 7 bounds nothing: the vehicle makes 3 m/s"]


def test_without_a_file_it_says_what_is_built_in(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_verb("check", "check", []) == 0
    assert capsys.readouterr().out.startswith("no config file: the built-in simulated car: good\n")


def test_the_file_found_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.toml").write_text("robot = 'archangel'\n")
    assert run_verb("check", "check", []) == 0
    assert capsys.readouterr().out.startswith("config.toml: good\nrobot    archangel\n")


def test_what_is_not_built_in_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.toml").write_text(
        "[bus]\nconnect = ['tcp/pi:7447']\n[drivers.pca9685]\naddress = 0x41\nbus = 1\n[speeds]\nturn = 1.0\n"
        "[drive.sources.nav]\npriority = 40\n"
    )
    assert run_verb("check", "check", []) == 0
    assert [line for line in capsys.readouterr().out.splitlines() if line.startswith("set ")] == [
        "set      bus.connect[0] = tcp/pi:7447",
        "set      drive.sources.nav.priority = 40",
        "set      drive.sources.nav.resume = false",
        "set      drive.sources.nav.silence = 0.3",
        "set      drive.sources.nav.trust = proof",
        "set      drivers.pca9685.address = 65, built in 64",
    ]


def test_a_bad_file_is_1_and_a_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "config.toml").write_text("[drive.servos.steering]\nchannel = 16\n")
    assert run_verb("check", "check", []) == 1
    words = "config.toml:2:1: drive.servos.steering.channel: expected a whole number from 0 to 15, found 16"
    assert capsys.readouterr() == ("", f"zteleop check: {words}\n")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('[keys]\nl = "toggle odom"', "no switch can be called odom: that is a topic of Odometry"),
        (
            '[launch]\nx = "actuatr"',
            "launch.x: no program 'actuatr', and no verb of zteleop; did you mean actuator?",
        ),
        ('[keys]\nbackspac = "stop robot"', "no key is called 'backspac'; did you mean backspace"),
    ],
)
def test_it_says_what_the_verbs_that_read_it_would_say(
    tmp_path: Path, text: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "config.toml").write_text(text)
    assert run_verb("check", "check", []) == 1
    assert words in capsys.readouterr().err
