import re
import tomllib
from hashlib import sha256

import pytest

from zteleop.bridges.web.files import FOLDER, HEADERS, TYPES, load


def test_every_file_of_the_folder_is_served_by_its_path_and_the_page_at_the_root() -> None:
    files = load()
    assert files["/"] == files["/index.html"]
    assert {path.name for path in FOLDER.iterdir() if path.is_file()} <= {path.strip("/") for path in files}
    assert all(file.type in TYPES.values() and file.body for file in files.values())


@pytest.mark.parametrize("path", ["/../files.py", "/static/index.html", "//", "/index", "/.", ""])
def test_nothing_else_is(path: str) -> None:
    assert path not in load()


def test_all_that_the_page_and_its_modules_load_is_there() -> None:
    files = load()
    page = files["/"].body.decode()
    wanted = {f"/{name}" for name in re.findall(r'(?:src|href)="([^"]+)"', page)}
    for path, file in files.items():
        if path.endswith(".js"):
            wanted |= {f"/{name}" for name in re.findall(r'from "\./([^"]+)"', file.body.decode())}
    assert wanted <= set(files)
    assert len(wanted) >= 5


def test_nothing_that_its_rules_forbid_stands_in_the_page() -> None:
    page = load()["/"].body.decode()
    assert "script-src 'self'" in HEADERS["Content-Security-Policy"]
    assert not re.search(r"<script(?![^>]* src=)|<style| on[a-z]+=| style=|https?://", page)


def test_it_is_light() -> None:
    assert sum(len(file.body) for path, file in load().items() if path != "/") <= 150_000


def test_what_others_wrote_is_as_they_published_it_and_says_under_which_licence() -> None:
    folder = FOLDER / "vendor"
    vendored = tomllib.loads((folder / "vendor.toml").read_text())
    sums = {name: digest for one in vendored.values() for name, digest in one["sha256"].items()}
    found = {path.name: sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()}
    assert found.pop("vendor.toml")
    assert found == sums
    for name, one in vendored.items():
        assert one["licence"] in (folder / f"{name}.LICENSE").read_text()
