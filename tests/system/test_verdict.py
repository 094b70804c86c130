"""The meter can tell waiting from working, and a run of tests does what its verdicts say."""

import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from rig import PATIENCE

from zteleop.chaos.waiting import Meter

TESTS = Path(__file__).parents[1]
CORE = min(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 0
WORKS = "import time\nend = time.process_time() + 0.3\nwhile time.process_time() < end: pass"
SLEEPS = "import time; time.sleep(0.5)"
SPINS = "print('spins', flush=True)\nwhile True: pass"


def on_one_core(text: str, **options: object) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-c", f"import os; os.sched_setaffinity(0, [{CORE}])\n{text}"]
    return subprocess.Popen(command, **options)  # type: ignore[call-overload]


@contextmanager
def busy_core(times: int) -> Iterator[None]:
    spinners = [on_one_core(SPINS, stdout=subprocess.PIPE) for _ in range(times)]
    try:
        for spinner in spinners:
            assert spinner.stdout
            assert spinner.stdout.readline() == b"spins\n"
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.communicate()


def took_and_waited(text: str) -> tuple[float, float]:
    """Return for how long a process ran, and for how much of it it waited."""
    began = time.monotonic()
    with on_one_core(text) as process:
        meter = Meter(lambda: [process.pid])
        while process.poll() is None:
            meter.glance()
            time.sleep(0.005)
        return time.monotonic() - began, meter.waited


def test_whoever_shares_a_core_is_seen_to_wait() -> None:
    with busy_core(3):
        took, waited = took_and_waited(WORKS)
    assert waited > 0.5 * (took - 0.3) > 0


def test_whoever_sleeps_beside_them_is_not() -> None:
    with busy_core(3):
        took, waited = took_and_waited(SLEEPS)
    assert took - waited >= 0.45


CONFTEST = """
from judging import *
import judging
judging.await_quiet = lambda patience: print("waits for quiet")
judging.stalls._pids = lambda: PIDS
PIDS = []
"""
TEST = """
import pytest
from processes import Unmet
from stall import stall
from verdict import NotJudged, excusable, judged

TRIED = []

{tests}
"""
STALL = f"""
import os, subprocess, sys, time
from conftest import PIDS

def stall():
    spin = "import os; os.sched_setaffinity(0, [{CORE}]); print(flush=True)\\nwhile True: pass"
    idle = "import os; os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))\\n" + spin
    both = [
        subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE) for text in (idle, spin, spin)
    ]
    PIDS[:] = [process.pid for process in both]
    for process in both:
        process.stdout.readline()
    time.sleep(0.7)
    for process in both[1:]:
        process.kill()
        process.wait()
        process.stdout.close()
    ran, give_up = cpu(both[0]), time.monotonic() + 30
    while cpu(both[0]) == ran and time.monotonic() < give_up:
        time.sleep(0.01)  # until the idle one has the core again, which is when its wait is counted
    time.sleep(0.2)  # and seen
    both[0].kill()
    both[0].wait()
    both[0].stdout.close()

def cpu(process):
    return int(open(f"/proc/{{process.pid}}/schedstat").read().split()[0])
"""
OTHERS = """
@pytest.mark.timing
@pytest.mark.parametrize("number", range(30))
def test_other(number):
    judged(0.05, 0.1, 0.0)
"""


@pytest.fixture
def run(tmp_path: Path) -> "Run":
    return Run(tmp_path)


class Run:
    """Runs tests of a test's own, as often as wanted, with one ledger."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "conftest.py").write_text(CONFTEST)
        (folder / "stall.py").write_text(STALL)
        (folder / "pytest.ini").write_text("[pytest]\nmarkers = timing: a duration\n")

    def __call__(self, tests: str, others: str = OTHERS) -> tuple[int, str]:
        (self.folder / "test_it.py").write_text(TEST.format(tests=tests + others))
        environment = {
            **os.environ,
            "PYTHONPATH": f"{TESTS}:{TESTS.parent}",
            "XDG_CACHE_HOME": str(self.folder / "cache"),
        }
        command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-sv", "test_it.py"]
        done = subprocess.run(
            command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=5 * PATIENCE
        )
        return done.returncode, done.stdout + done.stderr


def timing(body: str, name: str = "test_it") -> str:
    return f"@pytest.mark.timing\ndef {name}():\n    TRIED.append(1)\n    {body}\n"


def test_a_stall_is_tried_again_told_and_closes_nothing(run: Run) -> None:
    code, text = run(timing("judged(0.3, 0.1, 0.25)"))
    assert code == 0, text
    assert text.count("waits for quiet") == 2
    assert "NOT JUDGED test_it.py::test_it: 0.3000 s of at most 0.1000" in text
    assert "1 tests not judged, longest wait for a core 0.250 s" in text


def test_a_claim_that_can_be_judged_the_second_time_is(run: Run) -> None:
    code, text = run(timing("judged(0.3, 0.1, 0.25) if len(TRIED) < 2 else judged(0.05, 0.1, 0.0)"))
    assert (code, text.count("waits for quiet"), "NOT JUDGED" in text) == (0, 1, False), text
    code, text = run(timing("judged(0.3, 0.1, 0.25) if len(TRIED) < 2 else judged(0.3, 0.1, 0.0)"))
    assert (code, text.count("waits for quiet"), "NOT JUDGED" in text) == (1, 1, False), text


@pytest.mark.parametrize(
    "body",
    [
        "judged(0.3, 0.1, 0.1)",  # 0.2 s late, and 0.1 of it is nobody else's
        "judged(1.2, 0.1, 5.0)",  # ten times the bound
        "judged(0.01, 0.1, 0.0, not_before=0.05)",
        "assert False",
    ],
)
def test_what_the_machine_does_not_explain_fails_at_once(run: Run, body: str) -> None:
    code, text = run(timing(body))
    assert (code, text.count("waits for quiet")) == (1, 0), text


def test_what_a_machine_alone_can_break_is_excused_only_by_it(run: Run) -> None:
    busy = "with excusable({slack}):\n        assert False"
    code, text = run(timing(busy.format(slack=-1.0)))
    assert (code, "NOT JUDGED" in text) == (0, True), text
    code, text = run(timing(busy.format(slack=9.0)))
    assert (code, "NOT JUDGED" in text) == (1, False), text


ORDER = "def test_it():\n    TRIED.append(1)\n    {body}\n"


def test_what_a_machine_kept_from_happening_is_awaited_again(run: Run) -> None:
    fails = "stall()\n    if len(TRIED) < {}: raise Unmet('nothing came')"
    before_a_claim = timing(fails.format(4), "test_before_a_claim")
    code, text = run(ORDER.format(body=fails.format(2)) + before_a_claim)
    assert (code, text.count("waits for quiet"), "NOT JUDGED" in text) == (0, 2, False), text
    code, text = run(ORDER.format(body="stall()\n    raise Unmet('nothing came')"))
    assert (code, text.count("waits for quiet")) == (0, 2), text
    assert re.search(
        r"NOT JUDGED test_it.py::test_it: a process waited \d\.\d+ s for a core: nothing came", text
    )


@pytest.mark.parametrize(
    "body", ["raise Unmet('nothing came')", "stall()\n    assert False, 'it moved after a stop'"]
)
def test_what_never_came_on_a_quiet_machine_or_must_not_be_fails_at_once(run: Run, body: str) -> None:
    code, text = run(ORDER.format(body=body))
    assert (code, text.count("waits for quiet")) == (1, 0), text


def test_what_a_module_shares_is_made_anew_for_another_try(run: Run) -> None:
    shared = "@pytest.fixture(scope='module')\ndef shared():\n    return []\n\n"
    body = (
        "shared.append(1)\n    stall()\n    assert len(shared) == 1\n    if len(TRIED) < 2: raise Unmet('no')"
    )
    code, text = run(shared + ORDER.format(body=body).replace("test_it()", "test_it(shared)"))
    assert (code, text.count("waits for quiet")) == (0, 1), text


def test_too_many_without_a_verdict_close_the_gate(run: Run) -> None:
    tests = "".join(timing("judged(0.3, 0.1, 0.25)", f"test_{number}") for number in "ab")
    code, text = run(tests)
    assert code == 1
    assert "too many tests could not be judged: 2 of 32" in text


def test_one_that_is_never_judged_closes_it_in_the_third_run(run: Run) -> None:
    stuck, well = timing("judged(0.3, 0.1, 0.25)"), timing("judged(0.05, 0.1, 0.0)")
    assert [run(tests)[0] for tests in (stuck, stuck, well, stuck, stuck)] == [0, 0, 0, 0, 0]
    code, text = run(stuck)
    assert code == 1
    assert "test_it.py::test_it in 3 runs in a row" in text


def test_claims_of_time_run_last(run: Run) -> None:
    code, text = run(timing("pass", "test_first") + "def test_second(): pass\n", others="")
    assert code == 0
    assert text.index("test_second PASSED") < text.index("test_first PASSED")
