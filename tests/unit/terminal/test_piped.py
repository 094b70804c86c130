import os

import pytest

from zteleop.terminal.piped import PipedTerminal


def test_keys_come_from_a_pipe_until_it_ends_and_only_news_is_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    ear, mouth = os.pipe()
    with PipedTerminal(ear) as terminal:
        assert terminal.read() == b""
        os.write(mouth, b"w")
        assert terminal.read() == b"w"
        for lines in (["idle", "more"], ["idle"], ["driving"]):
            terminal.draw(lines)
        terminal.redraw()
        terminal.draw(["driving"])
        assert capsys.readouterr().out == "idle\ndriving\ndriving\n"
        assert not terminal.say("?")
        assert not terminal.switch_on("a", "b")
        os.close(mouth)
        with pytest.raises(EOFError):
            terminal.read()
    assert capsys.readouterr().out == "ended: the last word is neutral\n"
    assert os.get_blocking(ear)
    os.close(ear)
