"""What the pages show is run: programs beside a robot, settings by whoever reads them."""

import re
import runpy
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from rig import ROOT, Rig

from zteleop import Twist, config

PAGES = [*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md"]
BLOCK = re.compile(r"^```(python|toml)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
BLOCKS = [(page, kind, text) for page in PAGES for kind, text in BLOCK.findall(page.read_text())]
PROGRAMS = [(page, text) for page, kind, text in BLOCKS if kind == "python" and 'robot="archangel"' in text]
SETTINGS = [(page, text) for page, kind, text in BLOCKS if kind == "toml"]
ALONE = [(page, text) for page, kind, text in BLOCKS if kind == "python" and "archangel" not in text]


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("docs"), "archangel") as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def classroom(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """The course's robot, which drives the course's circles; a car has to be told that it drives no such."""
    with Rig(tmp_path_factory.mktemp("classroom"), "archangel") as bench:
        bench.actuator("--vehicle", "create3")
        yield bench


def names(blocks: list[tuple[Path, str]]) -> list[str]:
    return [f"{page.name} {number}" for number, (page, _) in enumerate(blocks)]


@pytest.mark.parametrize(("page", "text"), PROGRAMS, ids=names(PROGRAMS))
def test_a_program_of_a_page_runs_and_ends_quietly(
    request: pytest.FixtureRequest, page: Path, text: str
) -> None:
    rig = request.getfixturevalue("classroom" if page.name == "rclpy.md" else "rig")
    bus = f'bus=__import__("zteleop").BusSettings(connect=["{rig.endpoint}"], multicast=False)'
    wait = (
        'with __import__("contextlib").suppress(KeyboardInterrupt):\n'
        '    print("spins", flush=True); __import__("time").sleep(60)\n'
    )
    joined = text.replace('robot="archangel")', f'robot="archangel", {bus})')
    ready = joined.replace("node.spin()", 'print("spins", flush=True); node.spin()')
    assert joined != text
    process = rig.program(ready if "node.spin()" in text else f"{joined}\n{wait}")
    process.says("spins")
    process.signal(signal.SIGINT)
    assert process.ends() in (0, 130), process.text
    assert process.text == "spins"


@pytest.mark.parametrize(("page", "text"), SETTINGS, ids=names(SETTINGS))
def test_settings_of_a_page_are_understood(page: Path, text: str) -> None:
    config.parse(text.encode(), page.name)


@pytest.mark.parametrize(("page", "text"), ALONE, ids=names(ALONE))
def test_lines_of_a_page_that_need_no_robot_hold_for_the_example_they_speak_of(
    page: Path, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(ROOT / "examples")
    known = runpy.run_path(str(ROOT / "examples/test_there_and_back.py"))
    exec(text, {"Twist": Twist, **{name: known[name] for name in ("there_and_back", "at")}})


def test_the_pages_have_what_is_run_here() -> None:
    assert (len(PROGRAMS), len(ALONE), len(SETTINGS)) == (6, 2, 3)
