"""The house as design and pyproject draw it."""

import ast
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from statistics import median, quantiles

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
    lengths = {path: len(path.read_text().splitlines()) for path in SOURCES}
    nothing = {"utils", "util", "helpers", "common", "manager", "base", "misc"}
    assert [str(path) for path, lines in lengths.items() if lines > 300] == []
    assert median(lengths.values()) <= 90
    assert [str(path) for path in SOURCES if path.stem in nothing] == []


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


@pytest.fixture(scope="module")
def nodes() -> list[tuple[Path, ast.ClassDef | ast.FunctionDef]]:
    """Return each class and function of the package, and where it stands."""
    return [(path, node) for path in SOURCES for node in definitions(ast.parse(path.read_text()))]


def definitions(node: ast.AST) -> Iterator[ast.ClassDef | ast.FunctionDef]:
    """Yield each within a statement; expressions hold none, and are most of what there is."""
    for inner in ast.iter_child_nodes(node):
        if isinstance(inner, ast.ClassDef | ast.FunctionDef):
            yield inner
        if isinstance(inner, ast.stmt | ast.excepthandler | ast.match_case):
            yield from definitions(inner)


def test_functions_are_short(nodes: list[tuple[Path, ast.ClassDef | ast.FunctionDef]]) -> None:
    lengths = [
        node.end_lineno - node.lineno + 1
        for _, node in nodes
        if isinstance(node, ast.FunctionDef) and node.end_lineno
    ]
    assert median(lengths) <= 6
    assert quantiles(lengths, n=10)[-1] <= 14


def test_no_class_holds_more_than_fits_into_a_head(
    nodes: list[tuple[Path, ast.ClassDef | ast.FunctionDef]],
) -> None:
    """What ROS says in one message, and what a status tells, is as long as it is."""
    classes = [
        node for path, node in nodes if isinstance(node, ast.ClassDef) and path.parent.name != "messages"
    ]
    assert {node.name: len(held) for node in classes if len(held := fields(node)) > 14} == {}


def test_constructors_name_one_attribute_a_line(
    nodes: list[tuple[Path, ast.ClassDef | ast.FunctionDef]],
) -> None:
    """But for pairs that come from one call."""
    crowded = [
        f"{path.relative_to(ROOT)}:{assign.lineno}"
        for path, function in nodes
        if isinstance(function, ast.FunctionDef) and function.name == "__init__"
        for assign in ast.walk(function)
        if isinstance(assign, ast.Assign) and len(attributes(assign)) > 1 and not is_one_call(assign)
    ]
    assert crowded == []


def fields(node: ast.ClassDef) -> set[str]:
    """Return what instances hold: annotated in the class, or set by its methods."""
    declared = {
        n.target.id for n in node.body if isinstance(n, ast.AnnAssign) and isinstance(n.target, ast.Name)
    }
    set_ = (
        name for n in ast.walk(node) if isinstance(n, ast.Assign | ast.AnnAssign) for name in attributes(n)
    )
    return declared | set(set_)


def attributes(assign: ast.Assign | ast.AnnAssign) -> list[str]:
    """Return the attributes of self that a statement sets."""
    targets = assign.targets if isinstance(assign, ast.Assign) else [assign.target]
    flat = [
        part for target in targets for part in (target.elts if isinstance(target, ast.Tuple) else [target])
    ]
    return [
        part.attr
        for part in flat
        if isinstance(part, ast.Attribute) and isinstance(part.value, ast.Name) and part.value.id == "self"
    ]


def is_one_call(assign: ast.Assign) -> bool:
    return isinstance(assign.value, ast.Call)


def test_every_public_name_can_be_imported() -> None:
    for name in zteleop.__all__:
        assert getattr(zteleop, name).__name__ == name


def test_an_unknown_name_says_so() -> None:
    with pytest.raises(AttributeError, match="zteleop has no 'Nod'"):
        zteleop.__getattr__("Nod")


def test_every_link_between_pages_leads_somewhere() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "deploy").glob("*.md")]
    pages += [*(ROOT / "benchmarks").glob("*.md"), *(ROOT / "examples").glob("*.md")]
    dead = [
        f"{page.relative_to(ROOT)}: {link}"
        for page in pages
        for link in re.findall(r"\]\(([^)#\s]+)", page.read_text())
        if "://" not in link and not (page.parent / link).exists()
    ]
    assert len(pages) > 10
    assert dead == []
