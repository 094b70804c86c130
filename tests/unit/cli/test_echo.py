import pytest
import yaml
from unit.bus.fakes import Ring, put, sample

from zteleop.cli import echo
from zteleop.errors import BusError
from zteleop.messages import String, Twist
from zteleop.testing import Clock


def test_a_message_is_printed_as_yaml_that_can_be_read_back(capsys: pytest.CaptureFixture[str]) -> None:
    assert echo._print(sample(Twist.planar(0.5)), as_json=False)
    out = capsys.readouterr().out
    assert out.startswith("linear:\n  x: 0.5\n")
    assert out.endswith("---\n")
    (values, _) = yaml.safe_load_all(out)
    assert values["angular"] == {"x": 0.0, "y": 0.0, "z": 0.0}


def test_as_json_a_message_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert echo._print(sample(String("two\nlines")), as_json=True)
    assert capsys.readouterr().out == '{"data":"two\\nlines"}\n'


@pytest.mark.parametrize("text", ["\x1b[2J", "\x9b2J", "\x07"])
def test_what_could_steer_a_terminal_is_escaped(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    echo._print(sample(String(text)), as_json=False)
    assert text[0] not in capsys.readouterr().out


def test_what_cannot_be_read_is_said_on_stderr_escaped(capsys: pytest.CaptureFixture[str]) -> None:
    bad = put(b"\x00\x01", encoding="zenoh/bytes", key="robot/abe/\x1b[2J")
    assert not echo._print(bad, as_json=False)
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("robot/abe/\\u001b[2J: 2 bytes of 'zenoh/bytes', not JSON")


def test_a_delete_is_no_message(capsys: pytest.CaptureFixture[str]) -> None:
    assert not echo._print(put(b"{}", is_put=False), as_json=False)
    assert capsys.readouterr() == ("", "")


@pytest.fixture
def watch(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> Clock:
    monkeypatch.setattr("time.monotonic", clock.now)
    monkeypatch.setattr("time.sleep", clock.pass_by)
    return clock


def why_silent() -> str:
    return "abe/odom: nobody publishes it yet"


def test_it_gives_up_after_so_long_a_silence(watch: Clock) -> None:
    start = watch.time
    ring = Ring(sample(String("a")), sample(String("b")))
    heard = []
    with pytest.raises(BusError, match="for 2 s nothing was said on abe/odom: nobody publishes it yet"):
        heard.extend(iter(echo._samples(ring, 2.0, why_silent)))
    assert not ring.samples
    assert watch.time == pytest.approx(start + 2.0, abs=0.01)


@pytest.mark.parametrize(("timeout", "told"), [(3.0, 1), (0.5, 0), (float("nan"), 0)])
def test_who_waits_for_a_first_message_is_told_once_for_whom(
    watch: Clock, timeout: float, told: int, capsys: pytest.CaptureFixture[str]
) -> None:
    start = watch.time
    with pytest.raises(BusError):
        list(echo._samples(Ring(), timeout, why_silent))
    waits = "zteleop echo: waits for abe/odom: nobody publishes it yet\n"
    assert capsys.readouterr() == ("", waits * told)
    assert watch.time == pytest.approx(start + (timeout if timeout > 0 else 0.0), abs=0.01)


def test_without_a_timeout_it_hears_until_the_end(capsys: pytest.CaptureFixture[str]) -> None:
    samples = [sample(String("a")), sample(String("b"))]
    assert list(echo._samples(Ring(*samples), None, why_silent)) == samples
    assert capsys.readouterr().err == ""


def test_what_is_nested_too_deeply_for_yaml_is_said_and_no_end(capsys: pytest.CaptureFixture[str]) -> None:
    deep = put(b"[" * 900 + b"]" * 900, encoding="application/json", key="robot/abe/odom")
    assert not echo._print(deep, as_json=False)
    assert "1800 bytes of 'application/json', nested too deeply to show" in capsys.readouterr().err
    assert echo._print(deep, as_json=True)
