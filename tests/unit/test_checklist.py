"""The checklist and the safety argument name tests; each of them is there."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
NAMED = [
    named
    for page in ("docs/checklist.md", "docs/safety.md")
    for named in re.findall(r"`(tests/\S+)::(\w+)`", (ROOT / page).read_text())
]


def test_a_line_is_done_when_its_test_is_there() -> None:
    assert [(path, name) for path, name in NAMED if f"def {name}(" not in (ROOT / path).read_text()] == []


def test_the_pages_name_tests() -> None:
    assert len(NAMED) > 70
