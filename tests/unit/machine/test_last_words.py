"""What a process that has ended said last."""

from pathlib import Path

import pytest

from zteleop.machine.leash import last_words


@pytest.mark.parametrize(
    ("said", "last"),
    [("starts\nno chip here\n\n", "no chip here"), ("", "it said nothing"), ("\n", "it said nothing")],
)
def test_it_is_the_last_line_that_says_anything(tmp_path: Path, said: str, last: str) -> None:
    log = tmp_path / "log"
    log.write_text(said)
    assert last_words(log) == last
