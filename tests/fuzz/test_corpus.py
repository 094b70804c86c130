"""What was once a fault, or is likely to become one: replayed file by file."""

from pathlib import Path

import pytest
from fuzz.reading import corpus
from fuzz.targets import TARGETS


@pytest.fixture(autouse=True)
def _own_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))


@pytest.mark.parametrize(
    ("target", "file"),
    [pytest.param(target, file, id=f"{target}-{file.name}") for target in TARGETS for file in corpus(target)],
)
def test_a_file_of_the_corpus(target: str, file: Path) -> None:
    TARGETS[target](file.read_bytes())


def test_every_target_has_its_corpus() -> None:
    assert all(map(corpus, TARGETS))
