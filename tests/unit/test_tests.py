"""Two kinds of test: only tests/timing judges by seconds, and every other waits as long as it takes."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
LOGIC = [path for path in sorted(TESTS.rglob("test_*.py")) if path.parent.name in ("system", "faults")]
LOGIC += sorted((TESTS / "preload").glob("*.py"))  # cases that test_i2cdev runs
CLOCKS = {"monotonic", "perf_counter", "time", "now", "time_ns", "monotonic_ns"}
PATIENT = 30
"""s, the least that a test may wait for what must come; less is a bound"""
LOOSENS = {"test_bad_input.py": "so many lines a second: the longer it takes, the more there may be"}


def reads_clock(node: ast.AST, known: set[str]) -> bool:
    return any(
        (isinstance(n, ast.Call) and isinstance(n.func, ast.Attribute) and n.func.attr in CLOCKS)
        or (isinstance(n, ast.Name) and n.id in known)
        for n in ast.walk(node)
    )


def names_of_moments(tree: ast.AST) -> set[str]:
    """Return the names that hold what a clock said, or what was made of it."""
    known: set[str] = set()
    assignments = [n for n in ast.walk(tree) if isinstance(n, ast.Assign)]
    while True:
        more = {
            name.id
            for n in assignments
            if reads_clock(n.value, known)
            for target in n.targets
            for name in ast.walk(target)
            if isinstance(name, ast.Name)
        }
        if more <= known:
            return known
        known |= more


def bounds(text: str) -> Iterator[str]:
    """Yield each place where a verdict depends on seconds."""
    tree = ast.parse(text)
    for function in (n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)):
        known = names_of_moments(function)
        for claim in (n for n in ast.walk(function) if isinstance(n, ast.Assert)):
            if reads_clock(claim.test, known):
                yield f"line {claim.lineno}: {ast.unparse(claim.test)}"
    for call in (n for n in ast.walk(tree) if isinstance(n, ast.Call)):
        for keyword in call.keywords:
            value = keyword.value
            short = isinstance(value, ast.Constant) and isinstance(value.value, int | float)
            if keyword.arg in ("patience", "timeout") and short and value.value < PATIENT:
                yield f"line {call.lineno}: {keyword.arg}={value.value}"


@pytest.mark.parametrize("path", LOGIC, ids=lambda path: str(path.relative_to(TESTS)))
def test_no_verdict_outside_timing_depends_on_how_fast_the_machine_is(path: Path) -> None:
    if path.name in LOOSENS:
        return
    assert list(bounds(path.read_text())) == []


def test_there_are_both_kinds() -> None:
    assert len(LOGIC) > 15
    assert len(list((TESTS / "timing").glob("test_*.py"))) > 5


@pytest.mark.parametrize(
    "body",
    [
        "began = time.monotonic()\n    assert time.monotonic() - began < 1.0",
        "seconds = clock.now() - then\n    took = seconds\n    assert took < 1.0",
        "assert shell.ends(patience=2.0) == 1",
        "subprocess.run(command, timeout=10)",
    ],
)
def test_a_bound_is_found(body: str) -> None:
    assert list(bounds(f"def test_it():\n    {body}"))


def test_an_order_is_none() -> None:
    assert not list(bounds("def test_it():\n    until(lambda: rests, 'rest')\n    assert seen == [1, 2]"))
