"""How pytest runs claims of time: last, again when they could not be judged, and told at the end.

A claim of order can meet a machine as well that keeps a robot from its core: whoever drove must begin
anew then, and what a test awaits never comes. Where that was measured, it was not judged either. What
must not be, such as motion after a stop, no machine excuses.
"""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import processes
import pytest
from _pytest.runner import runtestprotocol
from _pytest.terminal import TerminalReporter
from stalls import Stalls
from verdict import NotJudged, waits

from zteleop.chaos.waiting import await_quiet

TRIES = 3
QUIET_WITHIN = 5.0
AT_MOST = 0.05
"""of the tests that a machine can disturb may stay without a verdict"""
IN_A_ROW = 3
"""runs in which the same test may not"""
ALONE = 20
"""of them at least, of which a share can be told"""
STALL = 0.15
"""s without a core that a robot may notice: its steps are due every 0.05 s, and late after 0.2 s"""
stalls = Stalls(lambda: [os.getpid(), *processes.pids()])


def is_timing(item: pytest.Item) -> bool:
    return item.get_closest_marker("timing") is not None


def awaits(item: pytest.Item) -> bool:
    """Say whether a test has processes, and awaits what they do; a claim of time does before it begins."""
    return is_timing(item) or "unit" not in item.path.parts


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave claims of time to the end, when nothing else of the suite is still ending."""
    items.sort(key=is_timing)


def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
    """Try a test again, with everything made anew, for as long as it cannot be judged."""
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for number in range(TRIES):
        if number:
            item.session._setupstate.teardown_exact(None)
            await_quiet(QUIET_WITHIN)
            item._initrequest()  # type: ignore[attr-defined]
        with stalls.watched(awaits(item)):
            reports = runtestprotocol(item, nextitem=nextitem, log=False)
        if not any(words_of(report) for report in reports):
            break
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Iterator[None]:  # yields the report, returns it
    report = yield
    report.claims = awaits(item)
    if call.excinfo and (words := why_not_judged(item, call.excinfo.value)):
        report.outcome, report.longrepr, report.not_judged = "passed", None, words
    elif report.failed and call.when == "call":
        report.sections += [(f"what {name} said", text) for name, text in processes.words() if text]
    if call.when == "teardown":
        processes.forget_the_ended()
    return report


def why_not_judged(item: pytest.Item, error: BaseException) -> str:
    """Return what kept a test from a verdict; nothing where it has one."""
    if isinstance(error, processes.Unmet) and awaits(item) and stalls.longest >= STALL:
        return f"a process waited {stalls.longest:.3f} s for a core: {str(error).splitlines()[0]}"
    return str(error) if isinstance(error, NotJudged) else ""


def words_of(report: pytest.TestReport) -> str:
    return getattr(report, "not_judged", "")


def pytest_report_teststatus(report: pytest.TestReport) -> tuple[str, str, str] | None:
    return ("not judged", "?", "NOT JUDGED") if words_of(report) else None


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Tell what was not judged, and what the machine did meanwhile."""
    unjudged = terminalreporter.stats.get("not judged", [])
    if waits or unjudged:
        terminalreporter.write_sep("-", "claims of time")
        longest = max((wait.waited for wait in waits), default=0.0)
        terminalreporter.write_line(
            f"{len(waits)} claims, {len(unjudged)} tests not judged, longest wait for a core {longest:.3f} s"
        )
    for report in unjudged:
        terminalreporter.write_line(f"NOT JUDGED {report.nodeid}: {words_of(report)}")


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Fail a run whose machine was too busy for too many of its claims, or for one again and again."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None:
        return  # a worker; what it found is told by whoever started it
    ran = {
        report.nodeid: report
        for reports in reporter.stats.values()
        for report in reports
        if isinstance(report, pytest.TestReport)
    }
    unjudged = {report.nodeid for report in reporter.stats.get("not judged", [])}
    claims = [nodeid for nodeid, report in ran.items() if getattr(report, "claims", False)]
    if not claims:
        return
    rows = Ledger(ledger_file()).note(claims, unjudged)
    stuck = sorted(nodeid for nodeid, row in rows.items() if row >= IN_A_ROW)
    if len(unjudged) > AT_MOST * max(len(claims), ALONE) or stuck:
        session.exitstatus = session.exitstatus or pytest.ExitCode.TESTS_FAILED
        reporter.write_line(
            f"too many tests could not be judged: {len(unjudged)} of {len(claims)}"
            + "".join(f"; {nodeid} in {rows[nodeid]} runs in a row" for nodeid in stuck)
        )


def ledger_file() -> Path:
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(cache) / "zteleop" / "tests-not-judged.json"


class Ledger:
    """In how many runs in a row each test was not judged; kept from run to run, wherever they run."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def note(self, ran: list[str], unjudged: set[str]) -> dict[str, int]:
        """Add a run; return the rows of those that were not judged."""
        rows = self._read()
        for nodeid in ran:
            row = rows.pop(nodeid, 0)
            if nodeid in unjudged:
                rows[nodeid] = row + 1
        self._write(rows)
        return {nodeid: rows[nodeid] for nodeid in unjudged}

    def _read(self) -> dict[str, int]:
        try:
            found = json.loads(self._file.read_text())
        except (OSError, ValueError):
            return {}
        return {str(k): int(v) for k, v in found.items()} if isinstance(found, dict) else {}

    def _write(self, rows: dict[str, int]) -> None:
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            fresh = self._file.with_suffix(f".{os.getpid()}")
            fresh.write_text(json.dumps(rows, indent=1))
            fresh.replace(self._file)
        except OSError:
            return  # a home that cannot be written keeps no rows
