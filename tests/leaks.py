"""Nothing that a test made outlives the run: no process, no folder, no network namespace, no mount."""

import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from _pytest.terminal import TerminalReporter

TAG = "ZTELEOP_TESTS"
"""in the environment of everything that a run starts; pytest adds which test it was"""


class Places:
    """What a test can leave behind that is no process, and which test it was."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="zt-"))  # short: the path of a socket holds 107 bytes
        self.roots = [self.folder]
        """where nothing may stay mounted"""
        self._by: dict[str, str] = {}

    def look(self, test: str) -> None:
        """Note what is there after a test and was not before."""
        self._by = {place: self._by.get(place, test) for place in self._found()}

    def left(self) -> list[str]:
        """Return what is there in the end, with whoever made it."""
        self.look("the end of the run")
        return [f"{place}, by {test}" for place, test in self._by.items()]

    def _found(self) -> Iterator[str]:
        yield from (f"the folder {self.folder / name}" for name in sorted(os.listdir(self.folder)))
        ours = f"zteleop-{os.getpid()}-"
        with suppress(OSError):
            names = [name for name in os.listdir("/run/netns") if name.startswith(ours)]
            yield from (f"the network namespace {name}" for name in names)
        with suppress(OSError):
            within = tuple(f"{root}/" for root in self.roots)
            mounts = [line.split()[1] for line in Path("/proc/mounts").read_text().splitlines()]
            yield from (f"the mount {place}" for place in mounts if place.startswith(within))


def end_processes(tag: str) -> list[str]:
    """End every other process of a run; return its command and its test."""
    ended = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it ends by itself, or is somebody else's
            words = (folder / "environ").read_bytes().decode(errors="replace").split("\0")
            told = dict(word.partition("=")[::2] for word in words)
            if told.get(TAG) == tag and int(folder.name) != os.getpid():
                command = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
                os.kill(int(folder.name), signal.SIGKILL)
                test = told.get("PYTEST_CURRENT_TEST", "no test that is known")
                ended.append(f"the process {folder.name} ({command.strip()[-80:]}), by {test}")
    return ended


class Leaks:
    """Names at the end of a run what its tests left behind, and fails it for that."""

    def __init__(self, config: pytest.Config) -> None:
        self._left: list[str] = []
        # What a test keeps for whoever looks into its failure is pytest's; all else is to be gone.
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", tempfile.gettempdir())
        self.places = Places()
        os.environ["TMPDIR"] = tempfile.tempdir = str(self.places.folder)
        self._is_worker = hasattr(config, "workerinput")
        if not self._is_worker:
            os.environ[TAG] = str(os.getpid())

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        self.places.look(nodeid)

    def pytest_testnodedown(self, node: Any) -> None:
        """Take over what a worker found."""
        self._left += getattr(node, "workeroutput", {}).get("left", [])

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        self._left += self.places.left()
        shutil.rmtree(self.places.folder, ignore_errors=True)
        if self._is_worker:
            session.config.workeroutput["left"] = self._left  # type: ignore[attr-defined]
            return
        self._left += end_processes(os.environ[TAG])
        if self._left:
            session.exitstatus = session.exitstatus or pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: TerminalReporter) -> None:
        if self._left:
            terminalreporter.write_sep("-", "left behind")
        for what in self._left:
            terminalreporter.write_line(f"LEFT BEHIND {what}")


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Leaks(config), Leaks.__name__)


@pytest.fixture(scope="session", autouse=True)
def nothing_stays_mounted(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> None:
    """Look for mounts where tests have their folders."""
    leaks: Leaks = request.config.pluginmanager.get_plugin(Leaks.__name__)
    leaks.places.roots.append(tmp_path_factory.getbasetemp())
