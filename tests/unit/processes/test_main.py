"""The way from a watchdog's command line to a program."""

from types import SimpleNamespace

import pytest

from zteleop.errors import DeviceError
from zteleop.processes import __main__ as module


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """What the door's program was run with; it ends with 7."""
    seen: list[tuple[object, ...]] = []
    program = SimpleNamespace(run=lambda *files: seen.append(files) or 7)
    monkeypatch.setattr(module, "import_module", {"zteleop.processes.door": program}.__getitem__)
    return seen


def test_a_program_is_run_with_the_files_it_inherits(run: list[tuple[object, ...]]) -> None:
    assert module.main(["door", "5", "8"]) == 7
    assert run == [(5, 8)]


@pytest.mark.parametrize(
    "arguments", [[], ["dor"], ["watchdog"], ["door", "x"], ["door", "-1"], ["__main__"]]
)
def test_who_runs_it_by_hand_is_told_what_to_run(
    arguments: list[str], run: list[tuple[object, ...]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert module.main(arguments) == 1
    assert "zteleop actuator starts everything" in capsys.readouterr().err
    assert run == []


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (DeviceError("nobody answers"), 1, "zteleop actuator: nobody answers\n"),
        (KeyboardInterrupt(), 130, ""),
    ],
)
def test_what_ends_it_is_said_as_by_what_was_typed(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException,
    code: int,
    said: str,
) -> None:
    def fail() -> None:
        raise error

    monkeypatch.setattr(module, "import_module", lambda name: SimpleNamespace(run=fail))
    assert module.main(["blackbox"]) == code
    assert capsys.readouterr().err == said
