import io
import sys

import pytest

from zteleop.cli._consent import ROOM_AHEAD, WHEELS_UP, ask_consent
from zteleop.errors import ConfigError


@pytest.mark.parametrize(("asked", "other"), [(WHEELS_UP, "room ahead"), (ROOM_AHEAD, "wheels up")])
def test_only_the_words_that_were_asked_for_let_it_go_on(
    asked: tuple[str, str], other: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(f"{asked[1]}\n{other}\n"))
    ask_consent("This moves.", asked)
    assert capsys.readouterr().err == f"This moves.\n{asked[0]} Type {asked[1]!r} to go on: "
    with pytest.raises(ConfigError, match=f"expected the words '{asked[1]}'"):
        ask_consent("This moves.", asked)
