"""A text file that somebody names."""

from pathlib import Path

import pytest

from zteleop.cli._text import LONGEST, read_text
from zteleop.errors import ConfigError


def test_what_it_says(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("größer")
    assert read_text(tmp_path / "file") == "größer"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\xff\xfe", "expected a text in UTF-8"),
        (b"x" * (LONGEST + 1), f"expected at most {LONGEST} bytes, found more"),
    ],
)
def test_what_is_no_text_or_too_long_is_refused_by_its_name(tmp_path: Path, data: bytes, words: str) -> None:
    file = tmp_path / "file"
    file.write_bytes(data)
    with pytest.raises(ConfigError, match=f"^{file}: {words}$"):
        read_text(file)


def test_what_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"cannot read .*none: No such file or directory"):
        read_text(tmp_path / "none")
