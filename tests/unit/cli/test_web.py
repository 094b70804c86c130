import argparse
from pathlib import Path

import pytest

from zteleop.cli import _pages, _run
from zteleop.errors import install


def test_a_port_is_a_number_that_fits() -> None:
    assert (_pages.port("0"), _pages.port("65535")) == (0, 65535)


@pytest.mark.parametrize("text", ["-1", "65536", "http", "", "8765.0", "9" * 5000])
def test_what_is_no_port_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="expected a port from 0 to 65535, found"):
        _pages.port(text)


def test_without_websockets_it_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(_pages, "find_spec", lambda name: None)
    assert _run.run_verb("web", "serve a page", []) == 1
    words = "zteleop web: a page needs websockets, which is not installed; say: "
    assert capsys.readouterr().err == f"{words}{install('web')}\n"


@pytest.mark.parametrize("typed", [["--port", "0"], ["--host", "pi.local"], ["--serve-at", "0.0.0.0"]])
def test_a_place_for_pages_is_refused_where_none_is_served(
    typed: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert _run.run_verb("calibrate", "find out", [*typed, "--robot", "abe"]) == 1
    assert "where a page is served is for --web: say that as well" in capsys.readouterr().err


def test_a_key_without_a_certificate_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert _run.run_verb("web", "serve a page", ["--tls-key", "car.key"]) == 1
    assert "a key alone is no identity: say --tls-cert as well" in capsys.readouterr().err
