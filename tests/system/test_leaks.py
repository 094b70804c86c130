"""A run of tests that leaves something behind names it and its test, and is red."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from rig import PATIENCE, until

TESTS = Path(__file__).parents[1]
SLEEPER = "subprocess.Popen(['sleep', '987'], start_new_session=True)"
CLEAN = "def test_it(): pass\n"


@pytest.fixture(params=["one after another", "by workers"])
def run(request: pytest.FixtureRequest, tmp_path: Path) -> "Run":
    return Run(tmp_path, [] if request.param == "one after another" else ["-n", "2"])


class Run:
    """Runs tests of a test's own."""

    def __init__(self, folder: Path, options: list[str]) -> None:
        self.folder, self._options = folder, options
        (folder / "conftest.py").write_text("from leaks import *\n")
        (folder / "pytest.ini").write_text("[pytest]\n")

    def __call__(self, tests: str) -> tuple[int, str]:
        (self.folder / "test_it.py").write_text(f"import os, subprocess, tempfile\n{tests}{CLEAN}")
        environment = os.environ | {"PYTHONPATH": f"{TESTS}:{TESTS.parent}"}
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *self._options, "test_it.py"]
        done = subprocess.run(
            command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=5 * PATIENCE
        )
        return done.returncode, done.stdout + done.stderr


def test_whoever_cleans_up_is_green(run: Run) -> None:
    code, text = run(f"def test_tidy():\n    with {SLEEPER} as process: process.kill()\n")
    assert (code, "LEFT BEHIND" in text) == (0, False), text


def test_a_process_that_is_left_is_named_with_its_test_and_ended(run: Run) -> None:
    pid = run.folder / "pid"
    code, text = run(f"def test_forgets():\n    open({str(pid)!r}, 'w').write(str({SLEEPER}.pid))\n")
    assert code == 1, text
    assert f"LEFT BEHIND the process {pid.read_text()} (sleep 987), by test_it.py::test_forgets" in text
    until(lambda: not Path(f"/proc/{pid.read_text()}/cmdline").exists(), "the end of the sleeper")


def test_a_folder_that_is_left_is_named_with_its_test(run: Run) -> None:
    code, text = run("def test_forgets(): tempfile.mkdtemp(prefix='forgotten-')\n")
    assert code == 1, text
    assert "/forgotten-" in text
    assert text.rstrip().count("by test_it.py::test_forgets") == 1, text


@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="mounting needs root")
def test_a_mount_and_a_namespace_that_are_left_are_named_with_their_test(run: Run) -> None:
    place, name = run.folder / "place", "zteleop-{os.getpid()}-forgotten"
    try:
        code, text = run(
            "def test_forgets(tmp_path):\n"
            "    place = tmp_path / 'disk'; place.mkdir()\n"
            f"    open({str(place)!r}, 'w').write(str(place))\n"
            "    subprocess.run(['mount', '-t', 'tmpfs', 'tmpfs', place], check=True)\n"
            f"    subprocess.run(['ip', 'netns', 'add', f{name!r}], check=True)\n"
        )
    finally:
        subprocess.run(["umount", "--lazy", place.read_text()], check=True)
    left = [line for line in text.splitlines() if line.startswith("LEFT BEHIND")]
    for line in left:
        if " namespace " in line:
            subprocess.run(["ip", "netns", "del", line.split()[5].rstrip(",")], check=True)
    assert code == 1, text
    assert [line.split()[3] for line in left] == ["network", "mount"]
    assert all(line.endswith("by test_it.py::test_forgets") for line in left)
