"""The house as design and pyproject draw it."""

import ast
import re
import tomllib
from pathlib import Path

import pytest
from importlinter.cli import EXIT_STATUS_SUCCESS, lint_imports

import zteleop
from zteleop.processes import PROGRAMS

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "zteleop").rglob("*.py"))


def test_imports_keep_every_contract(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    assert lint_imports(no_cache=True) == EXIT_STATUS_SUCCESS


def test_no_file_is_long_or_named_after_nothing() -> None:
    long = [str(path) for path in SOURCES if len(path.read_text().splitlines()) > 400]
    nothing = {"utils", "util", "helpers", "common", "manager", "base", "misc"}
    assert (long, [str(path) for path in SOURCES if path.stem in nothing]) == ([], [])


def test_every_room_says_in_its_first_line_what_is_in_it() -> None:
    for room in {path.parent for path in SOURCES} - {ROOT / "zteleop/chaos/sabotage"}:
        first = (ast.get_docstring(ast.parse((room / "__init__.py").read_text())) or "").split("\n")[0]
        assert first.endswith((".", ":")), f"{room.relative_to(ROOT)} begins with {first!r}"


def test_the_page_shows_every_room_on_its_floor_with_its_own_words() -> None:
    layers = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"][0][
        "layers"
    ]
    floor = {
        name.strip(" ()"): len(layers) - 1 - number
        for number, names in enumerate(layers)
        for name in names.split("|")
    }
    page = (ROOT / "docs/house.md").read_text()
    shown = re.findall(r"^\| (\d) \| `([a-z]+)(?:\.py)?` \| (.+) \|$", page, re.MULTILINE)
    rooms = {path.parent.name: path for path in (ROOT / "zteleop").glob("*/__init__.py")}
    rooms |= {name: ROOT / f"zteleop/{name}.py" for name in ("config", "errors")}
    assert {room: (int(number), words) for number, room, words in shown} == {
        room: (floor[room], (ast.get_docstring(ast.parse(path.read_text())) or "").split("\n")[0])
        for room, path in rooms.items()
    }


def test_the_page_shows_what_a_robot_is_made_of() -> None:
    page = (ROOT / "docs/house.md").read_text()
    assert re.findall(r"^\| `(\w+)` \| (.+) \| (\d+) \| (-?\d+) \| (.+) \|$", page, re.MULTILINE) == [
        (name, *map(str, program)) for name, program in PROGRAMS.items()
    ]


@pytest.mark.parametrize("page", ["house", "words"])
def test_what_a_page_points_to_is_there(page: str) -> None:
    places = re.findall(
        r"`([a-z_]+/(?:[a-z_0-9]+/)*(?:[a-z_0-9]+\.py)?)`", (ROOT / f"docs/{page}.md").read_text()
    )
    assert len(places) > 20
    assert [place for place in places if not (ROOT / "zteleop" / place).exists()] == []


def test_functions_are_short() -> None:
    lengths = sorted(
        node.end_lineno - node.lineno + 1
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef) and node.end_lineno
    )
    assert lengths[len(lengths) // 2] <= 8


def test_every_public_name_can_be_imported() -> None:
    for name in zteleop.__all__:
        assert getattr(zteleop, name).__name__ == name


def test_an_unknown_name_says_so() -> None:
    with pytest.raises(AttributeError, match="zteleop has no 'Nod'"):
        zteleop.__getattr__("Nod")
